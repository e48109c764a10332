// SPDX-License-Identifier: Apache-2.0
// Texts of cases in HTML pages, never interpreted as markup.
#pragma once

#include <string>
#include <string_view>

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

}  // namespace lumen
