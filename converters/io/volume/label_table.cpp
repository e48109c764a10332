// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/label_table.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "converters/base/csv_rows.h"
#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/text_header.h"
#include "formats/container/printable.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLargest = 1 << 24;  // the largest label that a volume of floats holds
constexpr std::uint64_t kMostBytes = 1 << 20;
constexpr std::string_view kSlicerTable = "# Color table";

/// Adds one name; `place` begins messages.
void addName(const std::string& place, const std::string& value, const std::string& name,
             LabelNames& names) {
  const std::optional<std::int64_t> label = parseInteger(value);
  if (!label || *label < 0 || *label > kLargest)
    throw invalidInput(place + "found the label " + quotedText(value) +
                       ", expected a whole number from 0 to 16777216");
  if (*label == 0) return;
  if (name.empty()) throw invalidInput(place + "the label " + value + " has no name; expected one");
  if (const auto fault = formats::checkText(name, formats::kMaxNameBytes, ""))
    throw invalidInput(place + "the name " + quotedText(name) +
                       " is no label of a branch; expected at most 255 bytes of UTF-8 without "
                       "control characters");
  if (!names.emplace(*label, name).second)
    throw invalidInput(place + "names the label " + value + " twice, expected each once");
}

std::string placeOf(const std::string& file, std::size_t line) {
  return file + ": line " + std::to_string(line) + ": ";
}

LabelNames namesOfJson(const std::string& text, const fs::path& file) {
  JsonFile json(text, file);
  const JsonPlace root(json);
  if (!root.value().isObject())
    root.refuse("an object of names by labels, such as {\"1\": \"BA\"}");
  LabelNames names;
  for (const formats::JsonMember& member : root.value().members()) {
    const std::string key(member.key);
    const std::string pointer = std::string("/").append(formats::jsonPointerToken(key));
    addName(json.place(pointer).append(": "), key, root.at(key).text(), names);
  }
  return names;
}

LabelNames namesOfSlicerTable(const std::string& text, const std::string& file) {
  LabelNames names;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string row = trimmed(text.substr(at, end - at));
    at = end + 1;
    ++line;
    if (row.empty() || row[0] == '#') continue;
    const std::vector<std::string> words = splitWords(row);
    if (words.size() != 6)
      throw invalidInput(placeOf(file, line) + "found " + quotedText(row) +
                         ", expected a label, a name and four numbers of a colour");
    std::string name = words[1];
    std::replace(name.begin(), name.end(), '_', ' ');
    addName(placeOf(file, line), words[0], name, names);
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

LabelNames namesOfCsv(const std::string& text, const std::string& file) {
  const std::vector<CsvRow> rows = csvRows(text, file);
  if (rows.empty())
    throw invalidInput(file + ": is empty; expected a row LABEL,NAME for each label");
  std::size_t value = 0, name = 1, first = 0;
  if (!parseInteger(rows[0].cells[0])) {
    const auto valueColumn =
        findColumn<5>(rows[0].cells, {"value", "labelvalue", "label", "index", "id"});
    const auto nameColumn = findColumn<1>(rows[0].cells, {"name"});
    if (!valueColumn || !nameColumn)
      throw invalidInput(
          placeOf(file, rows[0].line) + "found " + quotedText(rows[0].cells[0]) +
          ", expected a row LABEL,NAME, or a header with the columns value and name");
    value = *valueColumn;
    name = *nameColumn;
    first = 1;
  }
  LabelNames names;
  for (std::size_t i = first; i < rows.size(); ++i) {
    const std::string place = placeOf(file, rows[i].line);
    if (rows[i].cells.size() <= std::max(value, name))
      throw invalidInput(place + "found " + counted(rows[i].cells.size(), "cell", "cells") +
                         ", expected a label and a name");
    addName(place, rows[i].cells[value], rows[i].cells[name], names);
  }
  return names;
}

/// The organisers' classes of the TopCoW challenge, MUL_CLASS_LABEL_MAP of their evaluation
/// (K. Yang et al., "Benchmarking the CoW with the TopCoW Challenge", arXiv:2312.17670). 13 and 14 are
/// not in use.
const LabelNames& topcow() {
  static const LabelNames names = {{1, "BA"},     {2, "R-PCA"}, {3, "L-PCA"},  {4, "R-ICA"},
                                   {5, "R-MCA"},  {6, "L-ICA"}, {7, "L-MCA"},  {8, "R-Pcom"},
                                   {9, "L-Pcom"}, {10, "Acom"}, {11, "R-ACA"}, {12, "L-ACA"},
                                   {15, "3rd-A2"}};
  return names;
}

}  // namespace

const std::vector<std::string>& builtInLabelTables() {
  static const std::vector<std::string> names = {"topcow"};
  return names;
}

LabelNames readLabelTable(const InputFile& file) {
  if (!file.isInMemory() && file.path() == builtInLabelTables()[0]) return topcow();
  const std::string name = formats::printable(file.name());
  const std::string bytes = file.read("table of labels", kMostBytes);
  const std::string text(withoutByteOrderMark(bytes));
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  LabelNames names = first != text.npos && text[first] == '{' ? namesOfJson(text, file.path())
                     : text.starts_with(kSlicerTable)         ? namesOfSlicerTable(text, name)
                                                              : namesOfCsv(text, name);
  if (names.empty()) throw invalidInput(name + ": names no label but 0; expected names of labels");
  return names;
}

LabelNames segmentNames(const InputFile& file) {
  struct Segment {
    std::string value, name, layer = "0";
  };
  if (!file.isInMemory() && !fs::is_regular_file(file.path())) return {};
  HeaderLines lines(file);
  std::string line;
  if (!lines.next(line) || !line.starts_with("NRRD")) return {};
  std::map<std::string, Segment> segments;
  while (lines.next(line) && !trimmed(line).empty()) {
    const std::size_t equals = line.find(":="), underscore = line.find('_');
    if (equals == line.npos || underscore > equals || !line.starts_with("Segment")) continue;
    const std::string number = line.substr(7, underscore - 7);
    const std::string key = line.substr(underscore + 1, equals - underscore - 1);
    if (!parseInteger(number)) continue;
    const std::string value = trimmed(line.substr(equals + 2));
    if (key == "LabelValue") segments[number].value = value;
    if (key == "Name") segments[number].name = value;
    if (key == "Layer") segments[number].layer = value;
  }
  LabelNames names;
  for (const auto& [number, segment] : segments)
    if (!segment.value.empty() && segment.layer == "0")
      addName(formats::printable(file.path().string()) + ": Segment" + number + ": ", segment.value,
              segment.name, names);
  return names;
}

}  // namespace lumen::convert
