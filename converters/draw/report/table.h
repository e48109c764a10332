// SPDX-License-Identifier: Apache-2.0
// Tables of the report.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/html.h"

namespace lumen::convert {

struct Column {
  std::string title;
  bool isNumber = true;
};

/// A table whose head is repeated on each page and whose rows are not cut.
class Table {
public:
  Table(std::string id, std::vector<Column> columns)
      : m_id(std::move(id)), m_columns(std::move(columns)) {}

  /// One cell for each column.
  void row(const std::vector<Markup>& cells);
  [[nodiscard]] std::size_t rows() const { return m_count; }
  [[nodiscard]] Markup markup() const;

private:
  std::string m_id;
  std::vector<Column> m_columns;
  std::string m_rows;
  std::size_t m_count = 0;
};

}  // namespace lumen::convert
