// SPDX-License-Identifier: Apache-2.0
#include "converters/library/rows/build_list.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "converters/base/csv_rows.h"
#include "converters/base/error.h"
#include "converters/base/options/option_name.h"
#include "converters/base/options/option_value.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/index/record.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

using Cells = std::vector<std::string>;

constexpr std::size_t kMostFaultsReported = 20;
constexpr std::array<std::string_view, 4> kOwnColumns = {"input", "seeds", "id", "targets"};
constexpr std::array<std::string_view, 13> kAboutColumns = {
    "title",   "description", "anatomy", "codes",  "laterality", "modality",        "synthetic",
    "licence", "attribution", "doi",     "origin", "consent",    "deidentification"};

template <class List>
bool holds(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string linePrefix(std::size_t line) {
  return "line " + std::to_string(line) + ": ";
}

/// The parts between semicolons, without those that are empty.
std::vector<std::string> splitAtSemicolons(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::string part = trimmed(text.substr(at, end - at));
    if (!part.empty()) parts.push_back(part);
    at = end + 1;
  }
  return parts;
}

nlohmann::ordered_json codeJson(const std::string& text) {
  const AnatomyCode code = parseCode(text);
  if (code == AnatomyCode{})
    throw invalidInput("codes: found " + quotedText(text) + ", expected SYSTEM:CODE:NAME");
  return {{"system", code.system}, {"code", code.code}, {"name", code.name}};
}

bool synthetic(const std::string& word) {
  if (holds(std::array{"yes", "true", "1"}, word)) return true;
  if (holds(std::array{"no", "false", "0"}, word)) return false;
  throw invalidInput("synthetic: found " + quotedText(word) + ", expected yes or no");
}

void addAbout(nlohmann::ordered_json& about, const std::string& column, const std::string& cell) {
  const auto anatomy = [&about]() -> nlohmann::ordered_json& {
    if (!about.contains("anatomy"))
      about["anatomy"] = {{"text", ""}, {"codes", nlohmann::ordered_json::array()}};
    return about["anatomy"];
  };
  if (column == "anatomy") {
    anatomy()["text"] = cell;
  } else if (column == "codes") {
    auto codes = nlohmann::ordered_json::array();
    for (const std::string& code : splitAtSemicolons(cell)) codes.push_back(codeJson(code));
    anatomy()["codes"] = std::move(codes);
  } else if (column == "synthetic") {
    about["synthetic"] = synthetic(cell);
  } else {
    about[column] = cell;
  }
}

void addCell(BuildRow& row, nlohmann::ordered_json& about, const fs::path& folder,
             const std::string& column, const std::string& cell) {
  if (cell.empty()) return;
  if ((column == "input" || column == "seeds") && isAddress(cell))
    throw invalidInput(column + ": " + kAddressFault);
  if (column == "input")
    row.input = folder / cell;
  else if (column == "seeds")
    row.seeds = folder / cell;
  else if (column == "id")
    row.id = cell;
  else if (column == "targets")
    row.targets = splitAtSemicolons(cell);
  else if (column.starts_with("--"))
    row.options[column] = cell;
  else
    addAbout(about, column, cell);
}

void requireFile(const fs::path& file, const std::string& column) {
  std::error_code error;
  if (!fs::exists(file, error))
    throw invalidInput(column + ": there is no " + formats::printable(file.string()));
}

/// Fills in a row of the list; throws with the fault, without the place.
void parseRow(const Cells& names, const Cells& cells, const fs::path& folder, BuildRow& row) {
  if (cells.size() > names.size())
    throw invalidInput("found " + std::to_string(cells.size()) + " cells, expected " +
                       std::to_string(names.size()) + ": a text with a comma needs quotes");
  auto about = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!formats::isUtf8(cells[i])) throw invalidInput(names[i] + ": is not UTF-8");
    addCell(row, about, folder, names[i], cells[i]);
  }
  if (row.input.empty()) throw invalidInput("input: is empty; expected a file or a folder");
  requireFile(row.input, "input");
  if (!row.seeds.empty()) requireFile(row.seeds, "seeds");
  if (!row.id.empty() && !isCaseId(row.id))
    throw invalidInput("id: found " + quotedText(row.id) + ", expected " + kCaseIdRule);
  row.about = about.dump(2) + "\n";
  (void)readAbout(row.about, "the statements about it");
}

Cells namesOf(CsvRow row, const std::string& name) {
  const std::string line = linePrefix(row.line);
  Cells names = std::move(row.cells);
  for (std::string& column : names) {
    if (column == "volume") column = "input";
    if (std::count(names.begin(), names.end(), column) > 1)
      throw invalidInput(name + ": " + line + "two columns are called " + quotedText(column));
    if (holds(kOwnColumns, column) || holds(kAboutColumns, column)) continue;
    if (column.starts_with("--") && column.size() > 2) continue;
    throw invalidInput(
        name + ": " + line + "found a column " + quotedText(column) +
        ", expected input, seeds, id, targets, title, description, anatomy, codes, " +
        "laterality, modality, synthetic, licence, attribution, doi, origin, " +
        "consent, deidentification, or an option of lumen convert such as " + kOption.crop.shown());
  }
  if (!holds(names, "input"))
    throw invalidInput(name + ": " + line + "there is no column called input");
  return names;
}

/// Moves rows whose id a row before has to the faults.
void requireDifferentIds(BuildList& list) {
  std::map<std::string, std::size_t> first;
  std::erase_if(list.rows, [&](const BuildRow& row) {
    if (row.id.empty()) return false;
    const auto [other, isNew] = first.emplace(row.id, row.line);
    if (!isNew)
      list.faults.push_back(
          {row.line, row.id,
           "id: " + row.id + " is that of line " + std::to_string(other->second) + ", too"});
    return !isNew;
  });
}

}  // namespace

void requireNoFaults(std::vector<RowFault> faults, const fs::path& file) {
  if (faults.empty()) return;
  std::sort(faults.begin(), faults.end(),
            [](const RowFault& a, const RowFault& b) { return a.line < b.line; });
  const std::string name = formats::printable(file.string()) + ": ";
  std::string text;
  for (std::size_t i = 0; i < std::min(faults.size(), kMostFaultsReported); ++i)
    text += (i == 0 ? "" : "\n") + name + linePrefix(faults[i].line) + faults[i].why;
  if (faults.size() > kMostFaultsReported)
    text += "\nand " + std::to_string(faults.size() - kMostFaultsReported) + " more";
  throw invalidInput(text);
}

BuildList readBuildList(const std::string& text, const fs::path& file,
                        const std::set<std::size_t>& lines) {
  const std::string name = formats::printable(file.string());
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets write it
  std::vector<CsvRow> table =
      csvRows(text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text, name);
  if (table.empty()) throw invalidInput(name + ": is empty; expected a row of names first");
  const Cells names = namesOf(std::move(table.front()), name);
  BuildList list;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto& [line, cells] = table[i];
    if (!lines.empty() && !lines.contains(line)) continue;
    if (std::all_of(cells.begin(), cells.end(), [](const auto& c) { return c.empty(); })) continue;
    BuildRow row;
    row.line = line;
    try {
      parseRow(names, cells, file.parent_path(), row);
      list.rows.push_back(std::move(row));
    } catch (const Error& error) {
      list.faults.push_back({line, isCaseId(row.id) ? row.id : "", error.what()});
    }
  }
  requireDifferentIds(list);
  for (const std::size_t line : lines)
    if (std::none_of(table.begin() + 1, table.end(),
                     [line](const CsvRow& r) { return r.line == line; }))
      list.faults.push_back({line, "", "no row begins there"});
  if (list.rows.empty() && list.faults.empty())
    throw invalidInput(name + ": there is no row below the names");
  return list;
}

}  // namespace lumen::convert
