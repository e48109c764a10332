// SPDX-License-Identifier: Apache-2.0
// Figures, lines and columns for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lumen {

/// Fixed-point text; "-" for an empty or non-finite value.
std::string fixed(std::optional<double> value, int digits);

/// `value` with three significant digits, as a person reads it: "3614", "61.2", "0.52"; "?" for one
/// that is not finite.
std::string shownFigure(double value);

/// "1.2 MB"; decimal units, as files are sold.
std::string shownBytes(std::uint64_t bytes);

/// Lines, each with a name, padded to a column, and a value. Names and values are made printable,
/// so that no text of a file can end a line or begin one.
class Lines {
public:
  Lines& add(std::string_view name, std::string_view value);
  /// A line without a name.
  Lines& add(std::string_view line);
  [[nodiscard]] const std::string& text() const { return m_text; }

private:
  std::string m_text;
};

/// Rows of equal length as columns: the first left-aligned, the others right-aligned. Cells are
/// made printable.
std::string alignColumns(std::vector<std::vector<std::string>> rows);

}  // namespace lumen
