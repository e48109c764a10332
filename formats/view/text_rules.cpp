// SPDX-License-Identifier: Apache-2.0
#include "formats/view/text_rules.h"

#include <cmath>
#include <cstdint>
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

#if defined(LUMEN_ROUNDS_NUMBERS)

namespace {

/// "12.5" of the digits 125 and the exponent 1; "1.25e-09" where zeros would fill more than four
/// places.
std::string placed(const std::string& digits, int exponent) {
  const int count = static_cast<int>(digits.size());
  const auto at = [&](int place) { return static_cast<std::size_t>(place); };
  if (exponent < -4 || exponent > 15)
    return digits.substr(0, 1) + (count > 1 ? "." + digits.substr(1) : "") + "e" +
           std::to_string(exponent);
  if (exponent < 0) return "0." + std::string(at(-1 - exponent), '0') + digits;
  if (count <= exponent + 1) return digits + std::string(at(exponent + 1 - count), '0');
  return digits.substr(0, at(exponent + 1)) + "." + digits.substr(at(exponent + 1));
}

}  // namespace

void appendRounded(std::string& text, double value) {
  constexpr double kScale = 1e8;  // nine digits before the point
  if (std::isnan(value)) {
    text += "nan";
    return;
  }
  if (std::signbit(value)) text += "-";
  value = std::abs(value);
  if (std::isinf(value)) {
    text += "inf";
    return;
  }
  int exponent = 0;
  for (; value >= 10; ++exponent) value /= 10;
  for (; value > 0 && value < 1; --exponent) value *= 10;
  auto digits = static_cast<std::uint64_t>(value * kScale + 0.5);
  if (digits >= 10 * static_cast<std::uint64_t>(kScale)) ++exponent;
  while (digits > 9 && digits % 10 == 0) digits /= 10;
  text += placed(std::to_string(digits), exponent);
}

#endif

}  // namespace lumen::formats
