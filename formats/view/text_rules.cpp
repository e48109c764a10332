// SPDX-License-Identifier: Apache-2.0
#include "formats/view/text_rules.h"

#include <utility>

namespace lumen::formats {
namespace {

constexpr std::uint32_t kIllFormed = 0xffffffffu;

// The code point that starts at text[at], or kIllFormed; `at` moves past it.
std::uint32_t nextCodePoint(std::string_view text, std::size_t& at) {
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
    const auto next = static_cast<unsigned char>(text[at++]);
    if ((next & 0xc0u) != 0x80u) return kIllFormed;
    point = (point << 6) | (next & 0x3fu);
  }
  const bool surrogate = point >= 0xd800 && point < 0xe000;
  return point < smallest || surrogate || point > 0x10ffff ? kIllFormed : point;
}

}  // namespace

bool isUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();)
    if (nextCodePoint(text, at) == kIllFormed) return false;
  return true;
}

std::optional<Issue> checkText(std::string_view text, std::size_t maxBytes,
                               const std::string& pointer) {
  if (text.size() > maxBytes)
    return limitIssue(ErrorCode::TextLength, pointer, text.size(), maxBytes);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t start = at;
    const std::uint32_t point = nextCodePoint(text, at);
    const bool control = point < 0x20 || (point >= 0x7f && point < 0xa0);
    if (point != kIllFormed && !control) continue;
    const std::string where = std::to_string(start);
    return Issue{control ? ErrorCode::TextControl : ErrorCode::TextUtf8,
                 std::nullopt,
                 control ? "the text has a control character at its byte " + where
                         : "the text is not UTF-8 from its byte " + where + " on",
                 {{"found", where}},
                 pointer};
  }
  return std::nullopt;
}

void checkText(std::string_view text, std::size_t maxBytes, const std::string& pointer,
               IssueList& issues) {
  if (auto issue = checkText(text, maxBytes, pointer)) issues.add(*std::move(issue));
}

std::string jsonPointerToken(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~')
      token += "~0";
    else if (c == '/')
      token += "~1";
    else
      token += c;
  }
  return token;
}

}  // namespace lumen::formats
