// SPDX-License-Identifier: Apache-2.0
// Texts of cases in pages: they stay text, whatever they are.
#pragma once

#include <string>
#include <string_view>

namespace lumen {

/// `text` as the content of an element or as the value of an attribute in quotation marks of either kind: no
/// character of it is markup, and what does not show, or turns the direction of what follows, is written out
/// (formats::printable()). Not fit for scripts, styles and addresses.
std::string htmlText(std::string_view text);

/// The same as an element of its own: a text that runs from right to left leaves the order around it alone. Every
/// text that comes out of a case stands in one.
std::string htmlName(std::string_view text);

/// An address that is `bytes` themselves, such as the picture of an <img>. `type`: such as image/png.
std::string dataAddress(std::string_view type, std::string_view bytes);

}  // namespace lumen
