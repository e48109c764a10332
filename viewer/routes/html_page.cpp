// SPDX-License-Identifier: Apache-2.0
#include "viewer/routes/html_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include "converters/base/error.h"
#include "converters/base/html.h"
#include "converters/base/vectors.h"
#include "formats/case/case_encoding.h"
#include "formats/case/case_file.h"
#include "formats/json/base64.h"
#include "viewer/session/packs/case_pack.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

struct Known {
  const char *name, *file, *type;
};

constexpr std::array<Known, 4> kKnown = {{
    {"", "index.html", "text/html; charset=utf-8"},
    {"page.js", "page.js", "text/javascript; charset=utf-8"},
    {"page.css", "page.css", "text/css; charset=utf-8"},
    {"blob.wasm", "blob.wasm", "application/wasm"},
}};

}  // namespace

const char* const kNoPage =
    "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>lumen</title>\n"
    "<h1>The page of the viewer was not built</h1>\n"
    "<p>Building it needs npm: <code>apt install npm</code>, then <code>./bootstrap.sh demo</code> "
    "in lumen's folder.</p>\n</html>\n";

fs::path findPageFolder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  for (const char* const place : {"../share/lumen/viewer", "../../viewer/page"})
    // one without the other is a build that was interrupted
    if (const fs::path folder = program.parent_path() / place;
        fs::exists(folder / "index.html", error) && fs::exists(folder / "page.js", error))
      return folder;
  return {};
}

PageFiles findPageFiles() {
  PageFiles files;
  const fs::path folder = findPageFolder();
  if (folder.empty()) return files;
  for (const Known& known : kKnown)
    if (const auto bytes = formats::readFileBytes(folder / known.file))
      files[known.name] = {known.type,
                           {reinterpret_cast<const char*>(bytes->data()), bytes->size()}};
  return files;
}

namespace {

// Nothing may be fetched, from anywhere: script, style and data are all in the file.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'";

// The margin around the case shows where its vessels lie.
constexpr double kMargin = 3;  // radii of the widest vessel
// A browser holds embedded bytes three times while it opens.
constexpr std::size_t kMostVoxels = std::size_t{192} * 192 * 192;

/// Code that may stand in a script. Only these two texts can end or mislead a script, and bundled
/// code has them in strings and regular expressions alone, where the backslash changes nothing.
std::string inlineScript(std::string code) {
  for (const auto& [from, to] :
       {std::pair<std::string_view, std::string_view>{"</script", "<\\/script"},
        {"<!--", "<\\!--"}})
    for (std::size_t at = 0; (at = code.find(from, at)) != code.npos; at += to.size())
      code.replace(at, from.size(), to);
  return code;
}

std::string encodeBase64(std::string_view bytes) {
  return formats::base64(std::as_bytes(std::span(bytes)));
}

/// The box of the volume around the case, with its margin; all of it if there is none.
VolumeSending aroundCase(const Document& document) {
  VolumeSending sending;
  sending.eightBits = true;
  sending.mostVoxels = kMostVoxels;
  if (!document.value || document.value->tree.nodeCount() == 0) return sending;
  const formats::CenterlineTree& tree = document.value->tree;
  const convert::VolumeGeometry& geometry = document.volume->geometry;
  const double margin = kMargin * *std::max_element(tree.radius.begin(), tree.radius.end());
  Eigen::Vector3d low = geometry.indexFromWorld(toEigen(tree.centre.front())), high = low;
  for (const formats::Vec3f& centre : tree.centre) {
    const Eigen::Vector3d index = geometry.indexFromWorld(toEigen(centre));
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  const Eigen::Vector3d reach = (margin / geometry.spacing.array()).matrix();
  sending.crop = geometry.cellsAround(low - reach, high + reach);
  sending.cropped = true;
  return sending;
}

std::string encodeVolume(const Document& document) {
  const VolumePack pack(document.volume, document.labelOf(FileRole::Volume), aroundCase(document));
  std::string bytes;
  while (bytes.size() < pack.size()) bytes += pack.bytes(bytes.size(), pack.size());
  return bytes;
}

/// The parts of a case that libblob needs: tree and models.
std::string encodeModels(const formats::Case& value) {
  formats::Case models;
  models.metadata = value.metadata;
  models.tree = value.tree;
  models.models = value.models;
  const std::vector<std::byte> bytes = formats::encodeBinary(models);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The parts that the page finds instead of a server: names, and base64 of compressed bytes.
class Embedded {
public:
  void add(const std::string& name, std::string_view bytes) {
    m_parts[name] = encodeBase64(deflated(bytes));
  }
  void addSurface(const std::string& name, const Tagged& part) {
    if (part.bytes) add(name, compactPack(*part.bytes));
  }
  [[nodiscard]] std::string text(const Json& state) const {
    Json all;
    all["state"] = state;
    all["parts"] = m_parts;
    return jsonInScript(jsonText(all));
  }

private:
  Json m_parts = Json::object();
};

/// The members of the state that concern a page without a server. Revisions count the changes in
/// this program, which depends on timing; here each is 1, and 0 for the library, which is absent.
Json lookOnly(Json state) {
  state["revision"] = 1;
  for (Json& revision : state["revisions"]) revision = 1;
  for (const char* const name : {"library", "measures", "series", "second", "labels"})
    state["revisions"][name] = 0;
  for (const char* const name : {"undo", "redo", "job", "save_as", "second", "labels"})
    state[name] = nullptr;
  state["formats"] = state["proposals"] = Json::array();
  state["unsaved"] = state["measures_are_old"] = false;
  for (Json& file : state["files"]) file["named"] = false;  // the page reaches none
  return state;
}

const std::string& fileOf(const PageFiles& page, const char* name) {
  static const std::string none;
  const auto found = page.find(name);
  return found == page.end() ? none : found->second.bytes;
}

}  // namespace

HtmlOptions htmlOptions(const SavingOptions& options) {
  HtmlOptions result;
  for (const auto& [name, value] : options) {
    if (name == "volume" || name == "points")
      (name == "volume" ? result.volume : result.points) = value != "0" && value != "false";
    else if (name == "level" && (value == "0" || value == "1"))
      result.level = value == "1" ? 1 : 0;
    else
      throw Error(ErrorKind::Usage, "\"" + name + "\" is no option of the page as one file");
  }
  return result;
}

std::string htmlPage(Session& session, const PageFiles& page, const HtmlOptions& options,
                     Progress& progress) {
  if (page.empty())
    throw failed("the page of the viewer was not built; ./bootstrap.sh demo builds it, with npm");
  const Document document = session.now().document;
  if (!document.value && !document.volume)
    throw Error(ErrorKind::Usage, "there is neither a case nor a volume for the page to show");
  Embedded embedded;
  if (document.value) {
    embedded.add("case", casePack(*document.value, options.points, progress));
    if (document.hasModels()) embedded.add("case.lumen", encodeModels(*document.value));
    embedded.addSurface("surface", session.finishedSurface(options.level, progress));
  }
  if (document.volume && (options.volume || !document.value))
    embedded.add("volume", encodeVolume(document));
  for (const OpenMesh& mesh : document.meshes) {
    const std::string which = "?id=" + std::to_string(mesh.id);
    const Tagged part = meshPack(session.now(), mesh.id);
    embedded.addSurface("mesh" + which, part);
    if (const Tagged deviation = deviationPack(session.now(), mesh.id, progress); deviation.bytes)
      embedded.add("deviation" + which, compactDistances(*part.bytes, *deviation.bytes));
  }
  if (!fileOf(page, "blob.wasm").empty()) embedded.add("blob.wasm", fileOf(page, "blob.wasm"));
  Json state = lookOnly(session.state());
  state["has_volume"] = document.volume && (options.volume || !document.value);
  std::string style = fileOf(page, "page.css");
  if (style.find("</style") != style.npos) throw failed("page.css would end its own element");
  PageHead head;
  head.policy = kPolicy;
  head.title = state["title"].get<std::string>();
  head.links = "<style>" + style + "</style>\n";
  return htmlPage(
      head, "<lumen-case></lumen-case>\n<script type=\"application/json\" id=\"lumen-embedded\">" +
                embedded.text(state) + "</script>\n<script>" +
                inlineScript(fileOf(page, "page.js")) + "</script>\n");
}

std::string pageOfCase(std::string_view bytes, const std::string& name, Progress& progress) {
  Session session({});
  session.open({InputFile(name, bytes), name}, progress);
  return htmlPage(session, findPageFiles(), {}, progress);
}

}  // namespace lumen::viewer
