// SPDX-License-Identifier: Apache-2.0
// HTML pages: texts are never interpreted as markup, as a type of its own keeps the two apart.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumen {

/// `text` as the content of an element or as the value of an attribute in quotation marks of either
/// kind: no character of it is markup, and invisible characters and those that turn the direction
/// of the text are written out (formats::printable()). Not fit for scripts, styles and addresses.
std::string htmlText(std::string_view text);

/// `text`, escaped for HTML, in an element of its own, which isolates text that runs from right to
/// left. Every text out of a case stands in one.
std::string htmlName(std::string_view text);

/// A data URL of `bytes`, such as the picture of an <img>. `type`: such as image/png.
std::string dataAddress(std::string_view type, std::string_view bytes);

/// A path as a relative address: all but letters, digits, "-", ".", "_", "~" and "/"
/// percent-encoded (RFC 3986). Fit for an attribute.
std::string urlAddress(std::string_view path);

/// JSON (UTF-8) as a value in a script, inside of an HTML page or not: "<", ">", "&" and line
/// separators become escapes, which only strings of JSON can hold.
std::string jsonInScript(std::string_view json);

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

/// A pair of a list of facts, with the end of its line. `what` is ours.
Markup factRow(std::string_view what, const Markup& value);
/// Names and their values.
using Facts = std::vector<std::pair<std::string, Markup>>;
Markup factList(const Facts& facts);

/// Frame around the content of a page. All parts but the title are ours: they are not escaped.
struct PageHead {
  std::string_view policy;  ///< Content-Security-Policy
  std::string_view viewport = "width=device-width";
  std::vector<std::pair<std::string_view, std::string_view>> meta;  ///< names and contents
  std::string title;                                                ///< any text
  std::string links;           ///< elements of the head behind the title
  std::string bodyAttributes;  ///< such as " class=\"one\""
};
/// A whole page, in English and UTF-8.
std::string htmlPage(const PageHead& head, std::string_view content);

}  // namespace lumen
