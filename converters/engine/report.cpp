// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

std::size_t blobCount(const formats::Case& value) {
  return value.models ? value.models->centre.size() : 0;
}

std::size_t pointCount(const formats::Case& value) {
  return value.points ? value.points->position.size() : 0;
}

/// Characters of UTF-8 text, near enough to its columns on a terminal.
std::size_t textWidth(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace

Json jsonNumber(float value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double shortest = 0;
  std::from_chars(text.data(), end, shortest);
  return shortest;
}

Json jsonNumber(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

Json caseSummary(const formats::Case& value) {
  Json json;
  json["branches"] = value.tree.branches.size();
  json["nodes"] = value.tree.nodeCount();
  json["points"] = pointCount(value);
  json["blobs"] = blobCount(value);
  json["length_mm"] = jsonNumber(totalLength(value.tree));
  return json;
}

std::string caseLine(const std::string& file, const formats::Case& value) {
  return formats::printable(file) + ": " +
         counted(value.tree.branches.size(), "branch", "branches") + ", " +
         counted(value.tree.nodeCount(), "node", "nodes") + ", " +
         counted(pointCount(value), "point", "points") + ", " +
         counted(blobCount(value), "blob", "blobs") + ", " + fixed(totalLength(value.tree), 1) +
         " mm\n";
}

std::string fixed(std::optional<double> value, int digits) {
  if (!value || !std::isfinite(*value)) return "-";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, *value);
  return text.data();
}

Lines& Lines::add(std::string_view name, std::string_view value) {
  constexpr std::size_t kColumn = 14;
  std::string first = formats::printable(name);
  first.resize(std::max(first.size() + 1, kColumn), ' ');
  return add(first + std::string(value));
}

Lines& Lines::add(std::string_view line) {
  m_text += formats::printable(line) + "\n";
  return *this;
}

std::string alignColumns(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows)
    for (std::string& cell : row) cell = formats::printable(cell);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], textWidth(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - textWidth(row[c]), ' ');
      if (c == 0)
        text += row[c] + (row.size() > 1 ? padding : "");
      else
        text += "  " + padding + row[c];
    }
    text += '\n';
  }
  return text;
}

void answer(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) throw failed("standard output cannot be written to");
}

void answerJson(const Json& value) {
  answer(value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace lumen::app
