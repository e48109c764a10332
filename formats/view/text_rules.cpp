// SPDX-License-Identifier: Apache-2.0
#include "formats/view/text_rules.h"

#include <utility>

#include "formats/container/utf8.h"

namespace lumen::formats {
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
    const bool control = isControl(point);
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
