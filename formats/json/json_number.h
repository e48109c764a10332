// SPDX-License-Identifier: Apache-2.0
// Numbers of JSON texts. The field that a number belongs to decides the type that it is rounded to.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <nlohmann/json_fwd.hpp>

namespace lumen::formats {

/// The nearest real to the decimal, ties to even; a zero with its sign for a number that is too
/// small. Nothing for a number that rounds to beyond the largest real.
std::optional<double> doubleFromText(std::string_view text);
std::optional<float> floatFromText(std::string_view text);

/// The nearest float to a double, ties to even; nothing beyond the largest.
std::optional<float> floatFromDouble(double value);

/// The integer of a text without point and exponent; nothing if the type does not hold it.
template <class Integer>
std::optional<Integer> integerFromText(std::string_view text) {
  if (text == "-0") return Integer{0};
  Integer value{};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{}) return std::nullopt;
  return value;
}

/// A number of a JsonDocument, which must outlive it. Every reader of JSON asks it for the type of
/// its field; a number of any size is legal until then.
class JsonNumber {
public:
  /// True for a number without point and exponent.
  [[nodiscard]] bool isWhole() const;
  /// The number in at most 40 characters, for a message.
  [[nodiscard]] std::string shown() const;

  /// The nearest real, rounded once; nothing beyond the largest.
  [[nodiscard]] std::optional<double> asDouble() const;
  [[nodiscard]] std::optional<float> asFloat() const;
  /// The integer; nothing for a number with a point or an exponent, or one outside of the type.
  template <class Integer>
  [[nodiscard]] std::optional<Integer> asInteger() const {
    if (const auto* text = std::get_if<std::string_view>(&m_value))
      return isWhole() ? integerFromText<Integer>(*text) : std::nullopt;
    const auto* whole = std::get_if<std::int64_t>(&m_value);
    if (whole == nullptr || !std::in_range<Integer>(*whole)) return std::nullopt;
    return static_cast<Integer>(*whole);
  }

private:
  friend class JsonValue;
  explicit JsonNumber(std::variant<std::int64_t, double, std::string_view> value)
      : m_value(value) {}

  // The text, where neither an integer of 64 bits nor a double gives every type its nearest value
  std::variant<std::int64_t, double, std::string_view> m_value;
};

/// A number as a JsonDocument stores it.
nlohmann::json storedNumber(std::string_view text, bool whole);

}  // namespace lumen::formats
