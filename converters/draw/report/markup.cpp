// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/markup.h"

#include "converters/base/html.h"
#include "formats/container/utf8.h"

namespace lumen::convert {

Markup text(std::string_view text) {
  return {htmlText(text)};
}

Markup name(std::string_view text) {
  return {htmlName(text)};
}

Markup shortened(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return name(text);
  std::size_t end = 0;
  for (std::size_t at = 0; at < bytes;) {
    end = at;
    if (formats::nextCodePoint(text, at) == formats::kIllFormed) at = end + 1;
  }
  Markup result = name(text.substr(0, end));
  result.html += " … (" + std::to_string(text.size()) + " bytes)";
  return result;
}

Markup element(std::string_view tag, const Markup& content, std::string_view attributes) {
  Markup result{"<"};
  result.html += tag;
  if (!attributes.empty()) result.html += ' ';
  result.html += attributes;
  result.html += '>';
  result.html += content.html;
  result.html += "</";
  result.html += tag;
  result.html += '>';
  return result;
}

Markup paragraph(std::string_view ours) {
  return {element("p", text(ours)).html + "\n"};
}

Markup pngFigure(std::string_view png, const Markup& caption, std::string_view alt,
                 std::string_view attributes) {
  Markup image{"<img alt=\"" + htmlText(alt) + "\" src=\"" + dataAddress("image/png", png) + "\">"};
  image += element("figcaption", caption);
  return {element("figure", image, attributes).html + "\n"};
}

Markup section(std::string_view id, std::string_view title, const Markup& content) {
  Markup inside = element("h2", text(title));
  inside.html += '\n';
  inside += content;
  return {element("section", inside, "id=\"" + htmlText(id) + "\"").html + "\n"};
}

Markup factList(const Facts& facts) {
  Markup pairs;
  for (const auto& [what, value] : facts) {
    Markup pair = element("dt", text(what));
    pair += element("dd", value);
    pairs += element("div", pair);
    pairs.html += '\n';
  }
  return {element("dl", pairs).html + "\n"};
}

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
