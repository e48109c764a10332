// SPDX-License-Identifier: Apache-2.0
// Numbers in the text files of other programs. JSON has its own: formats/json/json_number.h.
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>

#include "formats/json/json_number.h"

namespace lumen {

/// The double nearest to a decimal number, which may begin with a plus sign; a zero with its sign
/// for a number too small for a double, and infinity for one too large. "inf" and "nan" name values
/// that are not finite. Empty for a word that is no number.
inline std::optional<double> parsedNumber(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc{}) return value;
  const double infinity = std::numeric_limits<double>::infinity();
  return formats::doubleFromText(word).value_or(word.starts_with('-') ? -infinity : infinity);
}

/// The text after a UTF-8 byte-order mark, which some editors and spreadsheets write first.
inline std::string_view withoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace lumen
