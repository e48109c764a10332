// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/library_answer.h"

#include <array>

#include "formats/container/printable.h"

namespace lumen::engine {

std::string bytesText(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits = {"kB", "MB", "GB", "TB", "PB"};
  if (bytes < 1000) return counted(bytes, "byte", "bytes");
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < kUnits.size()) {
    value /= 1000;
    ++unit;
  }
  return fixed(value, value < 9.95 ? 1 : 0) + " " + kUnits[unit];
}

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
