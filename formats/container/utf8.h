// SPDX-License-Identifier: Apache-2.0
// UTF-8 (RFC 3629) read strictly: no overlong forms, no surrogates, nothing above U+10FFFF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lumen::formats {

/// Result of nextCodePoint() for bytes that are not UTF-8.
constexpr std::uint32_t kIllFormed = 0xffffffffu;

/// The code point that starts at text[at], or kIllFormed. `at` moves past it; past what is
/// ill-formed it moves by one byte at least, and it never leaves the text.
constexpr std::uint32_t nextCodePoint(std::string_view text, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(text[at++]);
  if (lead < 0x80) return lead;
  int more = 0;
  std::uint32_t point = 0, smallest = 0;
  if (lead >= 0xc2 && lead < 0xe0) {
    more = 1, point = lead & 0x1fu, smallest = 0x80;
  } else if (lead >= 0xe0 && lead < 0xf0) {
    more = 2, point = lead & 0x0fu, smallest = 0x800;
  } else if (lead >= 0xf0 && lead < 0xf5) {
    more = 3, point = lead & 0x07u, smallest = 0x10000;
  } else {
    return kIllFormed;
  }
  for (; more > 0; --more) {
    if (at == text.size()) return kIllFormed;
    const auto next = static_cast<unsigned char>(text[at]);
    if ((next & 0xc0u) != 0x80u) return kIllFormed;
    point = (point << 6) | (next & 0x3fu), ++at;
  }
  const bool surrogate = point >= 0xd800 && point < 0xe000;
  return point < smallest || surrogate || point > 0x10ffff ? kIllFormed : point;
}

/// True for U+0000 to U+001F and U+007F to U+009F, which no text of a case may have.
constexpr bool isControl(std::uint32_t point) {
  return point < 0x20 || (point >= 0x7f && point < 0xa0);
}

}  // namespace lumen::formats
