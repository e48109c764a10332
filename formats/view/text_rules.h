// SPDX-License-Identifier: Apache-2.0
// Rules of every text in a case, and the spelling of pointers and numbers.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "formats/container/issue.h"

namespace lumen::formats {

/// True for well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF).
bool isUtf8(std::string_view text);

/// The fault of a text: TEXT_LENGTH, TEXT_UTF8 or TEXT_CONTROL (U+0000 to U+001F, U+007F to
/// U+009F), the first that applies, or nothing.
std::optional<Issue> checkText(std::string_view text, std::size_t maxBytes,
                               const std::string& pointer);
/// Adds the first fault of a text, if it has one, to `issues`.
void checkText(std::string_view text, std::size_t maxBytes, const std::string& pointer,
               IssueList& issues);

/// One step of a JSON pointer (RFC 6901).
std::string jsonPointerToken(std::string_view key);

/// The pointer to an element of an array.
inline std::string at(const std::string& array, std::size_t index) {
  return array + "/" + std::to_string(index);
}

#if defined(LUMEN_ROUNDS_NUMBERS)
/// Appends `value` with at most nine digits; "nan" and "inf" included. The tables of the shortest
/// text would be a third of the download of a page, which shows such numbers in messages alone.
void appendRounded(std::string& text, double value);
#endif

/// Appends the shortest text that reads back as `value`; "nan" and "inf" included.
template <class Number>
void appendNumber(std::string& text, Number value) {
#if defined(LUMEN_ROUNDS_NUMBERS)
  if constexpr (std::is_floating_point_v<Number>) return appendRounded(text, double{value});
#endif
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, result.ptr);
}

/// The shortest text that reads back as `value`; "nan" and "inf" included.
template <class Number>
std::string shortText(Number value) {
  std::string text;
  appendNumber(text, value);
  return text;
}

}  // namespace lumen::formats
