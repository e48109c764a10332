// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/library_answer.h"

#include <filesystem>
#include <utility>

#include "converters/base/shown_text.h"
#include "formats/container/printable.h"

namespace lumen::engine {

using convert::LibraryCheck;
using convert::LibraryFault;

namespace {

const char* severityOf(const LibraryFault& fault) {
  return formats::severityName(severityOf(fault.code));
}

Json faultJson(const LibraryFault& fault) {
  Json json;
  json["number"] = static_cast<int>(fault.code);
  json["code"] = convert::faultName(fault.code);
  json["severity"] = severityOf(fault);
  json["case"] = fault.caseId.empty() ? Json(nullptr) : Json(fault.caseId);
  json["path"] = formats::printable(fault.path);
  json["found"] = formats::printable(fault.found);
  json["expected"] = formats::printable(fault.expected);
  return json;
}

}  // namespace

std::string goneText(const std::vector<std::string>& gone) {
  if (gone.empty()) return {};
  std::string list;
  bool isSigned = false, hasPages = false;
  for (const std::string& path : gone) {
    list += (list.empty() ? "" : ", ") + formats::printable(path);
    isSigned = isSigned || path.starts_with("library.json.");
    hasPages = hasPages || path == "site" || path == "index.html";
  }
  std::string text = "removed with the old revision: " + list + "\n";
  if (isSigned) text += "lumen library sign signs the new revision\n";
  if (hasPages) text += "lumen library index makes its pages\n";
  return text;
}

Json librarySummary(const convert::LibraryFile& library) {
  return {{"id", library.id},
          {"revision", library.revision},
          {"title", library.title},
          {"publisher", library.publisher},
          {"licence", library.licence},
          {"date", library.date},
          {"count", library.cases.size()}};
}

Json changeJson(const convert::LibraryFile& library, const std::vector<std::string>& gone,
                const std::vector<std::string>& updated) {
  Json json = librarySummary(library);
  json["gone"] = gone;
  json["origin"] = nullptr;
  json["updated"] = updated;
  return json;
}

Json caseLineJson(const convert::CaseRecord& record, std::uint64_t bytes) {
  return {{"id", record.id},
          {"version", record.version},
          {"title", record.about.title},
          {"anatomy", record.about.anatomy},
          {"synthetic", record.about.synthetic},
          {"licence", record.about.licence},
          {"branches", record.figures.branches},
          {"length_mm", record.figures.length},
          {"files", record.files.size()},
          {"bytes", bytes}};
}

Json libraryCheckJson(const std::string& folder, const LibraryCheck& check) {
  Json json;
  json["library"] = formats::printable(folder);
  json["id"] = check.library ? Json(check.library->id) : Json(nullptr);
  json["title"] = check.library ? Json(check.library->title) : Json(nullptr);
  json["revision"] = check.library ? Json(check.library->revision) : Json(nullptr);
  json["cases"] = check.cases;
  json["passed_over"] = check.passedOver;
  json["files"] = check.files;
  json["bytes"] = check.bytes;
  json["errors"] = check.faults.counts().errors;
  json["warnings"] = check.faults.counts().warnings;
  json["complete"] = check.faults.kept().size() == check.faults.counts().total();
  json["faults"] = Json::array();
  for (const LibraryFault& fault : check.faults.kept()) json["faults"].push_back(faultJson(fault));
  return json;
}

std::string libraryFaultsText(const std::string& folder, const LibraryCheck& check) {
  Lines lines;
  for (const LibraryFault& fault : check.faults.kept())
    lines.add((std::filesystem::path(folder) / fault.path).string() + ": " + severityOf(fault) +
              " " + fault.text());
  if (check.faults.kept().size() < check.faults.counts().total())
    lines.add(folder + ": " + faultCounts(check) + ", " +
              std::to_string(check.faults.kept().size()) +
              " of them listed; --max-faults N lists more");
  return lines.text();
}

std::string libraryName(const LibraryCheck& check) {
  if (!check.library) return "";
  return "revision " + std::to_string(check.library->revision) + " of " +
         convert::quotedText(check.library->title);
}

std::string checkedText(const LibraryCheck& check) {
  std::string text = counted(check.cases, "case", "cases");
  if (check.passedOver > 0)
    text += " (" + std::to_string(check.passedOver) + " of them as they were when found whole)";
  return text + ", " + counted(check.files, "file", "files") + ", " +
         fixedText(static_cast<double>(check.bytes) / 1e6, 1) + " MB read";
}

std::string faultCounts(const LibraryCheck& check) {
  const std::size_t errors = check.faults.counts().errors,
                    warnings = check.faults.counts().warnings;
  const std::string ofErrors = counted(errors, "error", "errors");
  const std::string ofWarnings = counted(warnings, "warning", "warnings");
  return warnings == 0 ? ofErrors : errors == 0 ? ofWarnings : ofErrors + " and " + ofWarnings;
}

}  // namespace lumen::engine
