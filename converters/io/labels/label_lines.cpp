// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/label_lines.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/volume/text_header.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

constexpr std::int64_t kLargest = 1 << 24;  // the largest label that a volume of floats holds
constexpr std::string_view kSlicerTable = "# Color table";

struct Row {
  std::size_t line = 0;
  std::string text;
};

/// The lines that are neither empty nor comments.
std::vector<Row> rowsOf(const std::string& text) {
  std::vector<Row> rows;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string row = trimmed(text.substr(at, end - at));
    at = end + 1;
    ++line;
    if (!row.empty() && row[0] != '#') rows.push_back({line, row});
  }
  return rows;
}

bool areNumbers(const std::vector<std::string>& words, std::size_t first, std::size_t end) {
  if (words.size() < end) return false;
  for (std::size_t i = first; i < end; ++i)
    if (!parseInteger(words[i])) return false;
  return true;
}

/// A label, a name and the four numbers of a colour.
bool isColourRow(const std::vector<std::string>& words) {
  return words.size() == 6 && areNumbers(words, 0, 1) && areNumbers(words, 2, 6);
}

/// The text behind a label, three numbers of a colour, its opacity and two switches; nothing for
/// another row.
std::optional<std::string> nameOfSnap(const std::string& row) {
  const std::size_t open = row.find('"');
  if (open == row.npos || open + 1 >= row.size() || row.back() != '"') return {};
  const std::vector<std::string> words = splitWords(row.substr(0, open));
  constexpr std::size_t kNumbers = 7, kOpacity = 4;
  if (words.size() != kNumbers || !areNumbers(words, 0, kOpacity)) return {};
  return row.substr(open + 1, row.size() - open - 2);
}

}  // namespace

std::string linePlace(const std::string& file, std::size_t line) {
  return file + ": line " + std::to_string(line) + ": ";
}

void addLabelName(const std::string& place, const std::string& value, const std::string& name,
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

bool isColourTable(const std::string& text) {
  if (text.starts_with(kSlicerTable)) return true;
  const std::vector<Row> rows = rowsOf(text);
  return !rows.empty() &&
         (isColourRow(splitWords(rows[0].text)) || nameOfSnap(rows[0].text).has_value());
}

LabelNames namesOfColourTable(const std::string& text, const std::string& file) {
  const bool isOfSlicer = text.starts_with(kSlicerTable);
  const std::vector<Row> rows = rowsOf(text);
  const bool isOfSnap = !isOfSlicer && !rows.empty() && nameOfSnap(rows[0].text);
  LabelNames names;
  for (const Row& row : rows) {
    const std::string place = linePlace(file, row.line);
    const std::vector<std::string> words = splitWords(row.text);
    if (isOfSnap) {
      const std::optional<std::string> name = nameOfSnap(row.text);
      if (!name)
        throw invalidInput(place + "found " + quotedText(row.text) +
                           ", expected a label, six numbers and a name in quotes");
      addLabelName(place, words[0], *name, names);
      continue;
    }
    if (words.size() != 6)
      throw invalidInput(place + "found " + quotedText(row.text) +
                         ", expected a label, a name and four numbers of a colour");
    std::string name = words[1];
    if (isOfSlicer) std::replace(name.begin(), name.end(), '_', ' ');
    addLabelName(place, words[0], name, names);
  }
  return names;
}

}  // namespace lumen::convert
