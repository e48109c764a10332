// SPDX-License-Identifier: Apache-2.0
// Answers for standard output: JSON with stable names, and aligned text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/text.h"
#include "converters/base/tree_figures.h"
#include "formats/case/case.h"

namespace lumen::app {

using Json = nlohmann::ordered_json;

/// The number with the shortest decimal text that reads back as the same float; null if it is not
/// finite.
Json jsonNumber(float value);
Json jsonNumber(double value);

/// What convert, track and fit answer: branches, nodes, points, blobs, length_mm.
Json caseSummary(const formats::Case& value);

/// One line for a person: "out.lumen: 3 branches, 210 nodes, 1830 points, 902 blobs, 123.4 mm".
std::string caseLine(const std::string& file, const formats::Case& value);

/// Fixed-point text; "-" for nothing or a value that is not finite.
std::string fixed(std::optional<double> value, int digits);

/// Lines of a name, padded to a column, and a value. Names and values are made printable, so that
/// no text of a file can end a line or begin one.
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

/// Writes to standard output; throws Error(Failed) if it cannot take the text.
void answer(std::string_view text);
void answerJson(const Json& value);

}  // namespace lumen::app
