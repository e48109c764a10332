// SPDX-License-Identifier: Apache-2.0
// Numbers as texts, equal in every locale. A zero has no sign. The shortest text that reads back as
// the same number is shortText() of formats/view/text_rules.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace lumen {

/// Significant digits that read back as the same float.
inline constexpr int kFloatDigits = 9;

/// At most `digits` significant digits, for the files of other programs.
std::string numberText(double value, int digits = kFloatDigits);

/// At most `digits` significant digits, for people.
std::string shownNumber(double value, int digits = 6);

/// All numbers of a range with `between` between them: whole numbers in full, others as
/// shownNumber() writes them.
template <class Numbers>
std::string joinedNumbers(const Numbers& numbers, std::string_view between, int digits = 6) {
  std::string text, separator;
  for (const auto number : numbers) {
    text += separator;
    if constexpr (std::is_integral_v<decltype(number)>)
      text += std::to_string(number);
    else
      text += shownNumber(number, digits);
    separator = between;
  }
  return text;
}

/// At least nine significant digits, and as many as read back as the same double.
std::string exactText(double value);

/// `decimals` decimals; "-" for an empty or non-finite value.
std::string fixedText(std::optional<double> value, int decimals);

/// Six decimals, or "nan", "inf": a number of a file in a message that refuses it.
std::string foundNumber(double value);

/// `value` with three significant digits, as a person reads it: "3614", "61.2", "0.52"; "?" for one
/// that is not finite.
std::string shownFigure(double value);

/// "1.2 MB"; decimal units, as files are sold.
std::string shownBytes(std::uint64_t bytes);

/// `digits` digits or more, with zeros in front: "007".
std::string paddedNumber(std::uint64_t value, std::size_t digits);

}  // namespace lumen
