// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/table.h"

namespace lumen::convert {

void Table::row(const std::vector<Markup>& cells) {
  Markup row;
  for (std::size_t i = 0; i < m_columns.size(); ++i)
    row += element("td", i < cells.size() ? cells[i] : Markup{},
                   m_columns[i].isNumber ? "class=\"number\"" : "");
  m_rows += element("tr", row).html + "\n";
  ++m_count;
}

Markup Table::markup() const {
  Markup head;
  for (const Column& column : m_columns)
    head += element("th", text(column.title), column.isNumber ? "class=\"number\"" : "");
  Markup table = element("thead", element("tr", head));
  table.html += "\n<tbody>\n" + m_rows + "</tbody>";
  constexpr std::size_t kFew = 5;  // columns that need not fill the page
  const std::string size = m_columns.size() <= kFew ? " class=\"small\"" : "";
  return {element("table", table, "id=\"" + htmlText(m_id) + "\"" + size).html + "\n"};
}

}  // namespace lumen::convert
