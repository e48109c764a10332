// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/citation.h"

#include "converters/base/html.h"
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

void addField(std::string& entry, const char* name, const std::string& value) {
  if (value.empty()) return;
  entry += ",\n  ";
  entry += name;
  entry += " = {";
  entry += value;
  entry += "}";
}

/// Once more in braces, so that neither capitals nor the words of a name are taken apart.
std::string asOne(const std::string& text) {
  if (text.empty()) return text;
  std::string value = "{";
  value += bibTexText(text);
  value += "}";
  return value;
}

const char* commandFor(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '{':
      return "\\textbraceleft{}";
    case '}':
      return "\\textbraceright{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '&':
      return "\\&";
    case '%':
      return "\\%";
    case '$':
      return "\\$";
    case '#':
      return "\\#";
    case '_':
      return "\\_";
    default:
      return nullptr;
  }
}

}  // namespace

std::string bibTexText(std::string_view text) {
  std::string value;
  for (const char c : printable(text))
    if (const char* const command = commandFor(c))
      value += command;
    else
      value += c;
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
  text += "urn:uuid:";
  text += printable(library.id);
  return text;
}

std::string citationBibTex(const LibraryFile& library, const CaseRecord& record) {
  const CaseAbout& about = record.about;
  std::string entry = "@misc{";
  entry += record.id;
  entry += "-v";
  entry += std::to_string(record.version);
  addField(entry, "author",
           asOne(about.attribution.empty() ? library.publisher : about.attribution));
  addField(entry, "title", asOne(about.title));
  addField(entry, "year", yearOf(record));
  std::string where = "In: ";
  where += asOne(library.title);
  where += ", ";
  where += revisionOf(library);
  addField(entry, "howpublished", where);
  addField(entry, "publisher", about.attribution.empty() ? "" : asOne(library.publisher));
  addField(entry, "doi", urlAddress(about.doi));
  std::string note = "Version ";
  note += std::to_string(record.version);
  note += ". Licence: ";
  note += bibTexText(about.licence);
  note += ". urn:uuid:";
  note += bibTexText(library.id);
  addField(entry, "note", note);
  return entry + "\n}\n";
}

}  // namespace lumen::convert
