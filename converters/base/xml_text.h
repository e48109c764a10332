// SPDX-License-Identifier: Apache-2.0
// Texts of cases in XML 1.0 (W3C, Extensible Markup Language 1.0, fifth edition, section 2.2).
#pragma once

#include <string>
#include <string_view>

namespace lumen {

/// `text` as the content of an element, or as the value of an attribute in double quotation marks.
/// "_" replaces each character that XML forbids (controls, U+FFFE, U+FFFF, bytes that are not
/// UTF-8) or that an attribute loses (tabs and line breaks).
std::string xmlText(std::string_view text);

/// `text` as a comment, without two adjacent hyphens; forbidden characters as in xmlText(), line
/// breaks stay.
std::string xmlComment(std::string_view text);

}  // namespace lumen
