// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/label_table.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "converters/base/csv_rows.h"
#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/number_text.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/labels/known_tables.h"
#include "converters/io/labels/label_lines.h"
#include "converters/io/volume/text_header.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = 1 << 20;

/// The value of a label of nnU-Net: a number, or a list of one. Nothing for a region of several.
std::optional<std::string> valueInDataset(const JsonPlace& place) {
  if (!place.value().isArray()) return numberText(place.number());
  const std::vector<JsonPlace> values = place.elements();
  if (values.size() != 1) return {};
  return numberText(values.front().number());
}

LabelNames namesOfJson(const std::string& text, const fs::path& file) {
  JsonFile json(text, file);
  const JsonPlace root(json);
  if (!root.value().isObject())
    root.refuse("an object of names by labels, such as {\"1\": \"BA\"}");
  const bool isDataset = root.has("labels") && root.at("labels").value().isObject();
  const JsonPlace labels = isDataset ? root.at("labels") : root;
  LabelNames names;
  for (const formats::JsonMember& member : labels.value().members()) {
    const std::string key(member.key);
    const std::string pointer =
        std::string(isDataset ? "/labels/" : "/").append(formats::jsonPointerToken(key));
    const std::string place = json.place(pointer).append(": ");
    const JsonPlace value = labels.at(key);
    if (!isDataset || value.value().text() != nullptr) {
      addLabelName(place, key, value.text(), names);
    } else if (const auto label = valueInDataset(value)) {
      addLabelName(place, *label, key, names);
    }
  }
  return names;
}

/// The column with one of these names, in lower case.
template <std::size_t N>
std::optional<std::size_t> findColumn(const std::vector<std::string>& header,
                                      const std::array<std::string_view, N>& wanted) {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (std::find(wanted.begin(), wanted.end(), lowerCase(header[i])) != wanted.end()) return i;
  return std::nullopt;
}

/// Rows of values with tabs between them, which know no quotes.
std::vector<CsvRow> tabbedRows(const std::string& text) {
  std::vector<CsvRow> rows;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    CsvRow row{++line, {}};
    for (std::size_t cell = at; cell <= end;) {
      const std::size_t stop = std::min(text.find('\t', cell), end);
      row.cells.push_back(trimmed(text.substr(cell, stop - cell)));
      cell = stop + 1;
    }
    at = end + 1;
    if (row.cells.size() > 1 || !row.cells.front().empty()) rows.push_back(std::move(row));
  }
  return rows;
}

void addStatedRole(const std::string& place, const CsvRow& row, std::size_t value, std::size_t role,
                   LabelTable& table) {
  if (row.cells.size() <= role || row.cells[role].empty()) return;
  const auto stated = roleOfWord(lowerCase(row.cells[role]));
  if (!stated)
    throw invalidInput(place + "found the role " + quotedText(row.cells[role]) + ", expected " +
                       alternatives(roleWords()));
  const auto label = parseInteger(row.cells[value]);
  if (label && *label != 0) table.roles[*label] = *stated;
}

LabelTable tableOfRows(const std::vector<CsvRow>& rows, const std::string& file) {
  if (rows.empty())
    throw invalidInput(file + ": is empty; expected a row LABEL,NAME for each label");
  std::size_t value = 0, name = 1, first = 0;
  std::optional<std::size_t> role;
  if (!parseInteger(rows[0].cells[0])) {
    const auto valueColumn =
        findColumn<5>(rows[0].cells, {"value", "labelvalue", "label", "index", "id"});
    const auto nameColumn = findColumn<1>(rows[0].cells, {"name"});
    if (!valueColumn || !nameColumn)
      throw invalidInput(
          linePlace(file, rows[0].line) + "found " + quotedText(rows[0].cells[0]) +
          ", expected a row LABEL,NAME, or a header with the columns value and name");
    value = *valueColumn;
    name = *nameColumn;
    role = findColumn<1>(rows[0].cells, {"role"});
    first = 1;
  }
  LabelTable table;
  for (std::size_t i = first; i < rows.size(); ++i) {
    const std::string place = linePlace(file, rows[i].line);
    if (rows[i].cells.size() <= std::max(value, name))
      throw invalidInput(place + "found " + counted(rows[i].cells.size(), "cell", "cells") +
                         ", expected a label and a name");
    addLabelName(place, rows[i].cells[value], rows[i].cells[name], table.names);
    if (role) addStatedRole(place, rows[i], value, *role, table);
  }
  return table;
}

LabelTable tableOf(const KnownTable& known) {
  LabelTable table;
  for (const auto& [value, label] : known.labels) {
    table.names[value] = label.name;
    table.roles[value] = label.role;
  }
  table.from = known.title;
  return table;
}

bool isTabbed(const std::string& text) {
  const std::string first = text.substr(0, text.find('\n'));
  return first.find('\t') != first.npos && first.find(',') == first.npos;
}

}  // namespace

const std::vector<std::string>& builtInLabelTables() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const KnownTable& table : knownTables()) all.push_back(table.word);
    return all;
  }();
  return words;
}

LabelTable readLabelTable(const InputFile& file) {
  if (!file.isInMemory())
    if (const KnownTable* known = findKnownTable(file.name())) return tableOf(*known);
  const std::string name = formats::printable(file.name());
  const std::string bytes = file.read("table of labels", kMostBytes);
  const std::string text(withoutByteOrderMark(bytes));
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  LabelTable table;
  if (first != text.npos && text[first] == '{') {
    table.names = namesOfJson(text, file.path());
  } else if (isColourTable(text)) {
    table.names = namesOfColourTable(text, name);
  } else {
    table = tableOfRows(isTabbed(text) ? tabbedRows(text) : csvRows(text, name), name);
  }
  if (table.names.empty())
    throw invalidInput(name + ": names no label but 0; expected names of labels");
  table.from = file.path().filename().string();
  return table;
}

std::vector<InputFile> tablesBeside(const InputFile& map) {
  if (map.isInMemory()) return {};
  const fs::path folder = map.path().parent_path();
  std::string stem = map.path().filename().string();
  stem.erase(std::min(stem.find('.'), stem.size()));
  std::vector<fs::path> names;
  if (stem.ends_with("dseg")) names = {folder / (stem + ".tsv"), folder / "dseg.tsv"};
  names.push_back(folder / "dataset.json");
  if (folder.filename().string().starts_with("labelsT"))
    names.push_back(folder.parent_path() / "dataset.json");
  std::vector<InputFile> found;
  for (const fs::path& name : names)
    if (std::error_code ignored; fs::is_regular_file(name, ignored)) found.emplace_back(name);
  return found;
}

}  // namespace lumen::convert
