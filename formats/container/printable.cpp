// SPDX-License-Identifier: Apache-2.0
#include "formats/container/printable.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "formats/container/utf8.h"

namespace lumen::formats {
namespace {

struct Range {
  std::uint32_t first, last;
};

// Characters that do not show as themselves: Default_Ignorable_Code_Point of the Unicode Character
// Database without the variation selectors (which only choose a glyph), and the separators of
// lines.
constexpr auto kHidden = std::to_array<Range>({
    {0x00ad, 0x00ad},    // soft hyphen
    {0x034f, 0x034f},    // combining grapheme joiner
    {0x061c, 0x061c},    // Arabic letter mark
    {0x115f, 0x1160},    // Hangul fillers
    {0x17b4, 0x17b5},    // Khmer inherent vowels
    {0x180e, 0x180e},    // Mongolian vowel separator
    {0x200b, 0x200f},    // zero width, left-to-right and right-to-left marks
    {0x2028, 0x202e},    // line and paragraph separators, embeddings and overrides
    {0x2060, 0x206f},    // word joiner, invisible operators, isolates
    {0x3164, 0x3164},    // Hangul filler
    {0xfeff, 0xfeff},    // byte order mark
    {0xffa0, 0xffa0},    // half-width Hangul filler
    {0xfff0, 0xfffb},    // interlinear annotation
    {0x1bca0, 0x1bca3},  // shorthand format controls
    {0x1d173, 0x1d17a},  // musical format controls
    {0xe0000, 0xe00ff},  // tags
});

bool isHidden(std::uint32_t point) {
  if (isControl(point)) return true;
  return std::any_of(kHidden.begin(), kHidden.end(), [&](const Range& range) {
    return point >= range.first && point <= range.last;
  });
}

void appendEscape(std::string& out, char letter, std::uint32_t value, int digits) {
  constexpr char kHex[] = "0123456789abcdef";
  out += '\\';
  out += letter;
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += kHex[(value >> shift) & 15u];
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t start = at;
    const std::uint32_t point = nextCodePoint(text, at);
    if (point == kIllFormed) {
      at = start + 1;  // what follows may be a character of its own
      appendEscape(out, 'x', static_cast<unsigned char>(text[start]), 2);
    } else if (isHidden(point)) {
      point > 0xffff ? appendEscape(out, 'U', point, 8) : appendEscape(out, 'u', point, 4);
    } else {
      out += text.substr(start, at - start);
    }
  }
  return out;
}

}  // namespace lumen::formats
