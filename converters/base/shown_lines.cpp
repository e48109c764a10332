// SPDX-License-Identifier: Apache-2.0
#include "converters/base/shown_lines.h"

#include <algorithm>

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

Lines& Lines::add(std::string_view name, std::string_view value) {
  std::string first = formats::printable(name);
  first.resize(std::max(first.size() + 1, m_column), ' ');
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
  std::vector<bool> areSentences;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    areSentences.resize(widths.size(), false);
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths[c] = std::max(widths[c], textWidth(row[c]));
      if (row[c].find(' ') != std::string::npos) areSentences[c] = true;
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - textWidth(row[c]), ' ');
      if (c > 0) text += "  ";
      if (c == 0 || areSentences[c])
        text += row[c] + (c + 1 < row.size() ? padding : "");
      else
        text += padding + row[c];
    }
    text += '\n';
  }
  return text;
}

}  // namespace lumen
