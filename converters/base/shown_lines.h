// SPDX-License-Identifier: Apache-2.0
// Lines and columns for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lumen {

/// Characters before a value: room for names of up to 13 or of up to 11 characters.
inline constexpr std::size_t kColumn = 14, kNarrowColumn = 12;

/// Lines, each with a name, padded to a column, and a value. Names and values are made printable,
/// so that no text of a file can end a line or begin one.
class Lines {
public:
  explicit Lines(std::size_t column = kColumn) : m_column(column) {}
  Lines& add(std::string_view name, std::string_view value);
  /// A line without a name.
  Lines& add(std::string_view line);
  [[nodiscard]] const std::string& text() const { return m_text; }

private:
  std::size_t m_column;
  std::string m_text;
};

/// Rows of equal length as columns: the first one, and those with several words in a cell,
/// left-aligned, the others right-aligned. Cells are made printable.
std::string alignColumns(std::vector<std::vector<std::string>> rows);

}  // namespace lumen
