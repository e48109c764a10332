// SPDX-License-Identifier: Apache-2.0
// Pieces of a page: the words of a text cannot become markup, as a type of its own keeps them
// apart.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumen::convert {

/// HTML that is whole: every element that it opens it closes. Texts come in through text() and
/// name(), which escape.
struct Markup {
  std::string html;

  Markup& operator+=(const Markup& more) {
    html += more.html;
    return *this;
  }
};

/// A text of ours, such as a number.
Markup text(std::string_view text);
/// A text of a case, or a file's name.
Markup name(std::string_view text);
/// A text of a case, or a file's name, escaped: its first `bytes` or so, and then how many it has.
Markup shortened(std::string_view text, std::size_t bytes);

/// <tag attributes>content</tag>. `tag` and `attributes` are ours: they are not escaped.
Markup element(std::string_view tag, const Markup& content, std::string_view attributes = {});
Markup paragraph(std::string_view ours);
/// A figure of a picture in the PNG format. `alt` is for readers who do not see it; `attributes`
/// are those of the figure.
Markup pngFigure(std::string_view png, const Markup& caption, std::string_view alt,
                 std::string_view attributes = {});
/// <section id="id"><h2>title</h2>content</section>.
Markup section(std::string_view id, std::string_view title, const Markup& content);

/// Names and their values.
using Facts = std::vector<std::pair<std::string, Markup>>;
Markup factList(const Facts& facts);

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
