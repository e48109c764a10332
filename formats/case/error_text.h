// SPDX-License-Identifier: Apache-2.0
// Building the errors of this folder.
#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "formats/case/case_file.h"

namespace lumen::formats {

inline FormatError makeError(ErrorCode code, std::string place, std::string message) {
  return {errorName(code), std::move(place), std::move(message)};
}

inline std::string bytePlace(std::size_t offset) {
  return "byte " + std::to_string(offset);
}

/// One step of a JSON pointer (RFC 6901).
inline std::string jsonPointerToken(std::string_view key) {
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

/// The shortest text that reads back as `value`; "nan" and "inf" included.
template <class Number>
std::string shortText(Number value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

}  // namespace lumen::formats
