// SPDX-License-Identifier: Apache-2.0
// Citations of a case of a library.
#include <map>

#include "converters/base/html.h"
#include "converters/library/site/pages.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

using formats::printable;

/// A text as a sentence; nothing for none.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (text.back() != '.') text += '.';
  return text + " ";
}

/// Year of the revision that brought this version of the case.
std::string yearOf(const CaseRecord& record) {
  return record.date.substr(0, 4);
}

std::string revisionOf(const LibraryFile& library) {
  return "revision " + std::to_string(library.revision);
}

/// Once more in braces, so that neither capitals nor the words of a name are taken apart.
std::string asOne(const std::string& text) {
  return text.empty() ? text : "{" + bibTexText(text) + "}";
}

}  // namespace

std::string bibTexText(std::string_view text) {
  static const std::map<char, std::string_view> kCommands = {{'\\', "\\textbackslash{}"},
                                                             {'{', "\\textbraceleft{}"},
                                                             {'}', "\\textbraceright{}"},
                                                             {'~', "\\textasciitilde{}"},
                                                             {'^', "\\textasciicircum{}"},
                                                             {'&', "\\&"},
                                                             {'%', "\\%"},
                                                             {'$', "\\$"},
                                                             {'#', "\\#"},
                                                             {'_', "\\_"}};
  std::string value;
  for (const char c : printable(text)) {
    const auto command = kCommands.find(c);
    value += command == kCommands.end() ? std::string_view(&c, 1) : command->second;
  }
  return value;
}

std::string citationText(const LibraryFile& library, const CaseRecord& record) {
  std::string text = sentence(printable(record.about.attribution));
  text +=
      sentence(printable(record.about.title) + " (version " + std::to_string(record.version) + ")");
  text += sentence("In: " + printable(library.title) + ", " + revisionOf(library));
  text +=
      sentence(library.publisher.empty() ? yearOf(record)
                                         : printable(library.publisher) + ", " + yearOf(record));
  text += sentence(printable(record.about.licence));
  if (!record.about.doi.empty()) return text + "https://doi.org/" + urlAddress(record.about.doi);
  return text + "urn:uuid:" + printable(library.id);
}

std::string citationBibTex(const LibraryFile& library, const CaseRecord& record) {
  const CaseAbout& about = record.about;
  const bool isCredited = !about.attribution.empty();
  const std::string version = std::to_string(record.version);
  const std::pair<const char*, std::string> fields[] = {
      {"author", asOne(isCredited ? about.attribution : library.publisher)},
      {"title", asOne(about.title)},
      {"year", yearOf(record)},
      {"howpublished", "In: " + asOne(library.title) + ", " + revisionOf(library)},
      {"publisher", isCredited ? asOne(library.publisher) : ""},
      {"doi", urlAddress(about.doi)},
      {"note", "Version " + version + ". Licence: " + bibTexText(about.licence) +
                   ". urn:uuid:" + bibTexText(library.id)}};
  std::string entry = "@misc{" + record.id + "-v" + version;
  for (const auto& [name, value] : fields)
    if (!value.empty()) entry += std::string(",\n  ") + name + " = {" + value + "}";
  return entry + "\n}\n";
}

}  // namespace lumen::convert
