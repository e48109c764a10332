// SPDX-License-Identifier: Apache-2.0
#include "converters/base/xml_text.h"

#include <cstddef>
#include <cstdint>

#include "formats/container/utf8.h"

namespace lumen {

namespace {

bool isAllowed(std::uint32_t point) {
  return point != formats::kIllFormed && point >= ' ' && point != 0xfffe && point != 0xffff;
}

/// Calls `take` for each character of `text`, with "_" in the place of a forbidden one.
template <class Take>
void forEachCharacter(std::string_view text, const Take& take) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = at;
    const std::uint32_t point = formats::nextCodePoint(text, at);
    take(isAllowed(point) || point == '\n' ? text.substr(begin, at - begin) : "_");
  }
}

}  // namespace

std::string xmlText(std::string_view text) {
  std::string out;
  forEachCharacter(text, [&out](std::string_view character) {
    if (character == "&")
      out += "&amp;";
    else if (character == "<")
      out += "&lt;";
    else if (character == ">")
      out += "&gt;";
    else if (character == "\"")
      out += "&quot;";
    else
      out += character == "\n" ? "_" : character;
  });
  return out;
}

std::string xmlComment(std::string_view text) {
  std::string out;
  forEachCharacter(text, [&out](std::string_view character) {
    if (character == "-" && !out.empty() && out.back() == '-') out += ' ';
    out += character;
  });
  return out;
}

}  // namespace lumen
