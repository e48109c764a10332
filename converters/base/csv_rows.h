// SPDX-License-Identifier: Apache-2.0
// Comma-separated values (RFC 4180), as rows of cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace lumen::convert {

struct CsvRow {
  std::size_t line = 0;            ///< the row's first line; the first of a text is 1
  std::vector<std::string> cells;  ///< without white space around them
};

/// The rows of `text`, of a file that messages call `name`; empty lines are none. Throws
/// Error(InvalidInput), with the line, for breaches of RFC 4180. `separator`: between cells.
std::vector<CsvRow> csvRows(const std::string& text, const std::string& name, char separator = ',');

/// A text as a cell: in quotes where it has a comma, a quote or an end of line.
std::string csvCell(const std::string& text);

}  // namespace lumen::convert
