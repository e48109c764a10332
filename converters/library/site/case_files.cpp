// SPDX-License-Identifier: Apache-2.0
// Contents and origin of a case: files, commands that fetch them, citation, provenance.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/library/site/case_page.h"
#include "converters/library/site/case_texts.h"
#include "converters/library/site/citation.h"
#include "converters/library/site/notes.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

std::string fileRow(const CaseRecord& record, const RecordedFile& file) {
  std::string what = file.role;
  if (!file.target.empty()) what += " for " + file.target;
  return "<tr><th scope=\"row\"><a href=\"../../" + urlAddress(dataPath(record, file.path)) +
         "\" download>" + htmlText(file.path) + "</a></th><td>" + htmlText(what) +
         "</td><td class=\"number\">" + shownBytes(file.bytes) +
         "</td><td><code class=\"digest\">" + htmlText(file.sha256) + "</code></td></tr>\n";
}

/// Files by role, the most wanted first; those of one role by path.
std::vector<const RecordedFile*> inOrder(const CaseRecord& record) {
  constexpr std::array<const char*, 6> kRoles = {"case",   "surface", "export",
                                                 "report", "other",   "picture"};
  std::vector<const RecordedFile*> files;
  for (const char* const role : kRoles)
    for (const RecordedFile& file : record.files)
      if (file.role == role) files.push_back(&file);
  return files;
}

std::uint64_t totalBytes(const CaseRecord& record) {
  std::uint64_t bytes = 0;
  for (const RecordedFile& file : record.files) bytes += file.bytes;
  return bytes;
}

/// A value of a step as a person reads it: texts without quotation marks.
std::string valueText(const Json& value) {
  return htmlName(value.is_string() ? value.get<std::string>()
                                    : value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string memberText(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? std::string() : valueText(*found);
}

std::string stepText(const Json& step) {
  if (!step.is_object()) return {};
  std::string text = "<li><strong>" + memberText(step, "name") +
                     "</strong> <span class=\"quiet\">" + memberText(step, "tool") + "</span>";
  const auto parameters = step.find("parameters");
  if (parameters != step.end() && parameters->is_object() && !parameters->empty()) {
    text += "<details><summary>" + counted(parameters->size(), "parameter", "parameters") +
            "</summary>\n<dl class=\"wide\">\n";
    for (const auto& [name, value] : parameters->items())
      text += "<div><dt>" + htmlName(name) + "</dt><dd>" + valueText(value) + "</dd></div>\n";
    text += "</dl></details>";
  }
  return text + "</li>\n";
}

}  // namespace

std::string fetchCommands(const CaseRecord& record) {
  const std::string list = record.id + ".sha256";
  std::string commands = "cat > " + list + " <<'END'\n";
  for (const RecordedFile& file : record.files)
    commands += file.sha256 + "  " + dataPath(record, file.path) + "\n";
  commands += "END\nLIBRARY='ADDRESS OF THE LIBRARY'\ncut -c 67- " + list +
              " | while read -r file; do\n"
              "  curl --fail --silent --show-error --create-dirs -o \"$file\" \"$LIBRARY/$file\"\n"
              "done\nsha256sum -c " +
              list + "\n";
  return commands;
}

std::string filesSection(const CaseRecord& record) {
  std::string text =
      "<section id=\"files\"><h2>Files</h2>\n<p class=\"quiet\">" +
      counted(record.files.size(), "file", "files") + ", " + shownBytes(totalBytes(record)) +
      ". Digests are SHA-256, as <a href=\"../../" + urlAddress(dataPath(record, kRecordFile)) +
      "\">record.json</a> states them.</p>\n"
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Files\">\n<table>\n"
      "<thead><tr><th scope=\"col\">File</th><th scope=\"col\">What</th>"
      "<th scope=\"col\" class=\"number\">Size</th><th scope=\"col\">SHA-256</th></tr></thead>\n"
      "<tbody>\n";
  for (const RecordedFile* const file : inOrder(record)) text += fileRow(record, *file);
  text += "</tbody>\n</table>\n</div>\n<h3>Fetch and check all of them</h3>\n";
  return text + copyable("the commands that fetch and check", fetchCommands(record)) +
         "</section>\n";
}

std::string citeSection(const LibraryFile& library, const CaseRecord& record) {
  return "<section><h2>How to cite</h2>\n" +
         copyable("the citation", citationText(library, record)) +
         copyable("the BibTeX entry", citationBibTex(library, record)) + "</section>\n";
}

std::string provenanceSection(const CaseRecord& record) {
  const Json& provenance = record.provenance;
  if (!provenance.is_object()) return {};
  std::string text =
      "<section><h2>Provenance</h2>\n<dl class=\"wide\">\n<div><dt>Case as it was added</dt>"
      "<dd><code class=\"digest\">" +
      memberText(provenance, "case_sha256") + "</code></dd></div>\n<div><dt>Made by</dt><dd>" +
      memberText(provenance, "generator") + "</dd></div>\n";
  const auto source = provenance.find("source");
  if (source != provenance.end() && source->is_object())
    text += "<div><dt>Volume or mesh</dt><dd><code class=\"digest\">" +
            memberText(*source, "sha256") + "</code></dd></div>\n";
  text += "</dl>\n";
  const auto steps = provenance.find("steps");
  if (steps != provenance.end() && steps->is_array() && !steps->empty()) {
    text += "<ol class=\"steps\">\n";
    for (const Json& step : *steps) text += stepText(step);
    text += "</ol>\n";
  }
  return text + "</section>\n";
}

}  // namespace lumen::convert
