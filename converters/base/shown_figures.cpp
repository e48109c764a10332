// SPDX-License-Identifier: Apache-2.0
#include "converters/base/shown_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "formats/container/printable.h"

namespace lumen {

namespace {

/// Characters of UTF-8 text, an approximation of its columns on a terminal.
std::size_t textWidth(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace

std::string fixed(std::optional<double> value, int digits) {
  if (!value || !std::isfinite(*value)) return "-";
  std::array<char, 400> text{};  // the greatest double has 309 digits
  std::snprintf(text.data(), text.size(), "%.*f", digits, *value);
  return text.data();
}

std::string shownFigure(double value) {
  if (!std::isfinite(value)) return "?";
  const double size = std::abs(value);
  return fixed(value, size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
}

std::string shownBytes(std::uint64_t bytes) {
  if (bytes < 1000) return bytes == 1 ? "1 byte" : std::to_string(bytes) + " bytes";
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  constexpr std::array<const char*, 4> kUnits = {" kB", " MB", " GB", " TB"};
  for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fixed(value, value >= 9.95 ? 0 : 1) + kUnits[unit];
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

}  // namespace lumen
