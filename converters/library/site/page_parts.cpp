// SPDX-License-Identifier: Apache-2.0
// Parts that several pages have.
#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "converters/base/html.h"
#include "converters/base/options/option_name.h"
#include "converters/library/site/pages.h"

namespace lumen::convert {

/// The files of the ending .html beside this.
std::span<const EmbeddedText> siteTexts();

namespace {

// From disk the pages of some browsers have no origin that 'self' could mean, so the files there
// are named by their scheme; a page that came from a server cannot ask for any of those.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' file:; style-src 'self' file:; img-src 'self' file: "
    "data:; "
    "base-uri 'none'; form-action 'none'";

constexpr std::size_t kFewestFrames = 3;  // fewer are no turn
constexpr const char* kThumbnail = "thumbnail.png";

std::string signatureText(const std::string& root, const std::string& signature) {
  if (signature.empty())
    return "When this page was made, <strong>no signature</strong> "
           "(<code>library.json.minisig</code> "
           "or <code>library.json.sig</code>) lay beside <code>library.json</code>. Without one, "
           "digests show damage, but not who published what they belong to.";
  return "A signature, <a href=\"" + root + urlAddress(signature) + "\"><code>" +
         htmlText(signature) +
         "</code></a>, lay beside <code>library.json</code> when this page was made. "
         "<strong>This page has not verified it, and cannot</strong>: who changes a file can "
         "change the page.";
}

/// Steps to verify the library, with lumen and without.
std::string verifyingCommands(const std::string& signature) {
  std::string commands = "lumen library verify . " + kOption.key.shown() +
                         " PUBLISHER.pub   # in the folder of the library\n";
  if (signature.ends_with(".minisig"))
    commands += "minisign -V -p PUBLISHER.pub -m library.json\n";
  else if (signature.ends_with(".sig"))
    commands +=
        "ssh-keygen -Y verify -f ALLOWED_SIGNERS -I PUBLISHER -n lumen-library \\\n"
        "  -s library.json.sig < library.json\n";
  return commands;
}

/// The end of every page.
std::string footer(const LibraryFile& library, const std::string& root,
                   const std::string& signature) {
  return sitePart(
      "footer.html",
      {{"signature", signatureText(root, signature)},
       {"commands", copyable("the commands that verify", verifyingCommands(signature))},
       {"id", htmlText(library.id)},
       {"revision", std::to_string(library.revision)},
       {"date", htmlText(library.date)},
       {"all", root.empty() ? "" : "<a href=\"" + root + "index.html\">All cases</a> · "},
       {"root", root},
       {"generator", htmlText(library.generator)}});
}

/// Rest of "turn-007.png" or "turn/007.png" without its number: "turn-.png", "turn/.png"; empty for
/// others.
std::string turnName(const std::string& path) {
  constexpr std::size_t kDigits = 3;
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || dot < kDigits + 1) return {};
  if (const char before = path[dot - kDigits - 1]; before != '-' && before != '/') return {};
  for (std::size_t i = dot - kDigits; i < dot; ++i)
    if (path[i] < '0' || path[i] > '9') return {};
  return path.substr(0, dot - kDigits) + path.substr(dot);
}

bool isShown(const RecordedFile& file) {
  return file.role == "picture" &&
         (file.media == "image/png" || file.media == "image/jpeg" || file.media == "image/webp");
}

}  // namespace

std::string sitePart(std::string_view name, std::initializer_list<TextValue> values) {
  for (const EmbeddedText& text : siteTexts())
    if (text.name == name) return filled(text.bytes, values);
  throw std::logic_error("there is no part " + std::string(name));
}

std::string pageText(const PageFrame& frame, const std::string& content, const LibraryFile& library,
                     const std::string& signature) {
  PageHead head;
  head.policy = kPolicy;
  head.viewport = "width=device-width, initial-scale=1";
  head.meta = {{"color-scheme", "light dark"}, {"referrer", "no-referrer"}};
  head.title = frame.title;
  head.links = "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"" +
               frame.root + "site/site.css\">\n";
  for (const char* const script : frame.scripts)
    head.links +=
        "<script src=\"" + frame.root + "site/" + std::string(script) + "\" defer></script>\n";
  head.bodyAttributes = " data-root=\"" + frame.root + "\"" + frame.data;
  return htmlPage(head, content + footer(library, frame.root, signature));
}

std::string copyable(const std::string& name, const std::string& text) {
  std::string block =
      "<div class=\"copy\" data-name=\"" + htmlText(name) + "\"><pre tabindex=\"0\">";
  for (std::size_t at = 0; at < text.size();) {  // lines stay lines; all else as htmlText() has it
    const std::size_t end = text.find('\n', at);
    block += htmlText(std::string_view(text).substr(at, end - at)) + "\n";
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return block + "</pre></div>\n";
}

std::string kindOfCase(const CaseAbout& about) {
  static const std::map<std::string, std::string> kSources = {
      {"XA", "X-ray angiography"}, {"US", "ultrasound"}, {"other", "other source"}};
  const auto source = kSources.find(about.modality);
  return (about.anatomy.empty() ? "" : htmlName(about.anatomy) + " · ") +
         htmlText(about.laterality == "unknown" ? "side not stated" : about.laterality) + " · " +
         htmlText(source == kSources.end() ? about.modality : source->second);
}

std::string tagsOfCase(const CaseRecord& record) {
  return std::string(record.figures.aneurysms > 0 ? "<span class=\"tag mark\">aneurysm</span> "
                                                  : "") +
         "<span class=\"tag\">" + (record.about.synthetic ? "synthetic" : "patient") +
         "</span> <span class=\"tag\">" + htmlName(record.about.licence) + "</span>";
}

std::string doiLink(const std::string& doi) {
  if (doi.empty()) return {};
  return element("a", name(doi),
                 "rel=\"external noreferrer\" href=\"https://doi.org/" + urlAddress(doi) + "\"")
      .html;
}

std::string dataPath(const CaseRecord& record, const std::string& path) {
  return std::string(kPayload) + "/" + record.id + "/" + path;
}

std::string casePagePath(const std::string& id) {
  return "site/case/" + id + ".html";
}

CasePictures casePictures(const CaseRecord& record) {
  CasePictures pictures;
  std::vector<std::string> paths;
  std::map<std::string, std::vector<std::string>> turns;
  for (const RecordedFile& file : record.files) {
    if (!isShown(file)) continue;
    if (file.path == kThumbnail) {
      pictures.thumbnail = file.path;
      continue;
    }
    paths.push_back(file.path);
    if (const std::string turn = turnName(file.path); !turn.empty())
      turns[turn].push_back(file.path);
  }
  std::sort(paths.begin(), paths.end());
  for (auto& [name, frames] : turns)
    if (frames.size() >= kFewestFrames && frames.size() > pictures.frames.size())
      pictures.frames = std::move(frames);
  std::sort(pictures.frames.begin(), pictures.frames.end());
  for (const std::string& path : paths)
    if (!std::binary_search(pictures.frames.begin(), pictures.frames.end(), path))
      pictures.others.push_back(path);
  auto first = std::find(pictures.others.begin(), pictures.others.end(), "picture.png");
  if (first == pictures.others.end()) first = pictures.others.begin();
  if (first != pictures.others.end()) {
    pictures.first = *first;
    pictures.others.erase(first);
  } else if (!pictures.frames.empty()) {
    pictures.first = pictures.frames.front();
  }
  if (pictures.first.empty()) pictures.first = pictures.thumbnail;
  if (pictures.thumbnail.empty()) pictures.thumbnail = pictures.first;
  return pictures;
}

}  // namespace lumen::convert
