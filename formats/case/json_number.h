// SPDX-License-Identifier: Apache-2.0
// Numbers of a JSON text. Most are kept as an integer of 64 bits or as a double. Of the others (an
// integer beyond, a real beyond, or one that a double would round twice on its way to a float) the
// text is kept, until the field that it belongs to tells what it should be.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace lumen::formats {

/// The nearest to the decimal, ties to even; what is too small is a zero with its sign. Nothing if
/// it rounds to beyond the largest.
std::optional<double> doubleFromText(std::string_view text);
std::optional<float> floatFromText(std::string_view text);

/// The nearest to a double, ties to even; nothing beyond the largest.
std::optional<float> floatFromDouble(double value);

/// Of a number without point and exponent; nothing if it does not fit.
template <class Integer>
std::optional<Integer> integerFromText(std::string_view text) {
  if (text == "-0") return Integer{0};
  Integer value{};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{}) return std::nullopt;
  return value;
}

/// A number of a JSON text as a value of a document; `whole` is without point and exponent.
nlohmann::json numberValue(std::string_view text, bool whole);

/// The text of a number that is kept so, or nothing.
std::optional<std::string_view> keptText(const nlohmann::json& value);

/// True for a number, whichever way it is kept.
bool isNumber(const nlohmann::json& value);
/// True for a number without point and exponent.
bool isWhole(const nlohmann::json& value);
/// "array", "number" and so on: what messages call a value.
std::string kindOf(const nlohmann::json& value);
/// At most 40 characters of a number.
std::string numberText(const nlohmann::json& number);

/// A number as the type of its field; nothing if it does not fit.
std::optional<double> asDouble(const nlohmann::json& number);
std::optional<float> asFloat(const nlohmann::json& number);

/// The same of a number that isWhole().
template <class Integer>
std::optional<Integer> asInteger(const nlohmann::json& number) {
  if (const auto text = keptText(number)) return integerFromText<Integer>(*text);
  const auto value = number.get<std::int64_t>();
  return std::in_range<Integer>(value) ? std::optional(static_cast<Integer>(value)) : std::nullopt;
}

}  // namespace lumen::formats
