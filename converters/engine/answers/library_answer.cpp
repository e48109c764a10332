// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/library_answer.h"

#include "formats/container/printable.h"

namespace lumen::engine {

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

}  // namespace lumen::engine
