// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_number.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

using Json = nlohmann::json;

// Halfway between the largest float and the next power of two; from here on, numbers round beyond.
constexpr double kBeyondFloat = 0x1.ffffffp127;

// Whether a number that is out of range is too large rather than too small: the power of ten of its
// first digit that is not zero.
bool isTooLarge(std::string_view text) {
  const std::size_t exponentAt = std::min(text.find_first_of("eE"), text.size());
  const std::string_view digits = text.substr(0, exponentAt);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t first = std::min(digits.find_first_of("123456789"), digits.size());
  const auto power = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  if (exponentAt == text.size()) return power > 0;
  const bool isNegative = text.substr(exponentAt + 1).starts_with('-');
  std::string_view rest = text.substr(exponentAt + 1);
  if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
  // beyond this, digits in front cannot compensate: a text is shorter
  constexpr std::int64_t kHuge = std::int64_t{1} << 60;
  std::int64_t exponent = 0;
  if (std::from_chars(rest.data(), rest.data() + rest.size(), exponent).ec != std::errc{})
    exponent = kHuge;
  return (isNegative ? -std::min(exponent, kHuge) : std::min(exponent, kHuge)) + power > 0;
}

template <class Real>
std::optional<Real> realFromText(std::string_view text) {
  Real value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec == std::errc{} && std::isfinite(value)) return value;
  if (isTooLarge(text)) return std::nullopt;
  return text.starts_with('-') ? Real{-0.0f} : Real{0};
}

}  // namespace

std::optional<double> doubleFromText(std::string_view text) {
  return realFromText<double>(text);
}

std::optional<float> floatFromText(std::string_view text) {
  return realFromText<float>(text);
}

std::optional<float> floatFromDouble(double value) {
  if (!(std::abs(value) < kBeyondFloat)) return std::nullopt;
  return static_cast<float>(value);
}

Json storedNumber(std::string_view text, bool whole) {
  if (whole) {
    if (const auto integer = integerFromText<std::int64_t>(text)) return *integer;
  } else if (const auto value = doubleFromText(text)) {
    if (floatFromDouble(*value) == floatFromText(text)) return *value;
  }
  return Json::binary({text.begin(), text.end()});
}

bool JsonNumber::isWhole() const {
  if (const auto* text = std::get_if<std::string_view>(&m_value))
    return text->find_first_of(".eE") == text->npos;
  return std::holds_alternative<std::int64_t>(m_value);
}

std::string JsonNumber::shown() const {
  if (const auto* text = std::get_if<std::string_view>(&m_value))
    return std::string(text->substr(0, 40));
  if (const auto* whole = std::get_if<std::int64_t>(&m_value)) return std::to_string(*whole);
  return shortText(std::get<double>(m_value));
}

std::optional<double> JsonNumber::asDouble() const {
  if (const auto* text = std::get_if<std::string_view>(&m_value)) return doubleFromText(*text);
  if (const auto* whole = std::get_if<std::int64_t>(&m_value)) return static_cast<double>(*whole);
  return std::get<double>(m_value);
}

std::optional<float> JsonNumber::asFloat() const {
  if (const auto* text = std::get_if<std::string_view>(&m_value)) return floatFromText(*text);
  if (const auto* whole = std::get_if<std::int64_t>(&m_value)) return static_cast<float>(*whole);
  return floatFromDouble(std::get<double>(m_value));
}

}  // namespace lumen::formats
