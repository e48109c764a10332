// SPDX-License-Identifier: Apache-2.0
#include "converters/base/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace lumen {

namespace {

constexpr std::size_t kMostCharacters = 400;  // the greatest double has 309 digits

/// `value` as std::to_chars() writes it in the given format.
std::string written(double value, std::chars_format format, int digits) {
  std::array<char, kMostCharacters> text;
  char* const end = text.data() + text.size();
  return {text.data(), std::to_chars(text.data(), end, value, format, digits).ptr};
}

}  // namespace

std::string numberText(double value, int digits) {
  return written(value == 0 ? 0.0 : value, std::chars_format::general, digits);
}

std::string shownNumber(double value, int digits) {
  return numberText(value, digits);
}

std::string exactText(double value) {
  std::string text;
  for (int digits = 9; digits <= 17; ++digits) {
    text = numberText(value, digits);
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (read == value) break;
  }
  return text;
}

std::string fixedText(std::optional<double> value, int decimals) {
  if (!value || !std::isfinite(*value)) return "-";
  std::string text = written(*value, std::chars_format::fixed, decimals);
  const bool isZero = text.find_first_not_of("-0.") == std::string::npos;
  return isZero && text[0] == '-' ? text.substr(1) : text;
}

std::string foundNumber(double value) {
  return std::isfinite(value) ? fixedText(value, 6) : numberText(value);
}

std::string shownFigure(double value) {
  if (!std::isfinite(value)) return "?";
  const double size = std::abs(value);
  return fixedText(value, size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
}

std::string shownBytes(std::uint64_t bytes) {
  if (bytes < 1000) return bytes == 1 ? "1 byte" : std::to_string(bytes) + " bytes";
  double value = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  constexpr std::array<const char*, 5> kUnits = {" kB", " MB", " GB", " TB", " PB"};
  for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fixedText(value, value >= 9.95 ? 0 : 1) + kUnits[unit];
}

std::string paddedNumber(std::uint64_t value, std::size_t digits) {
  const std::string text = std::to_string(value);
  return text.size() < digits ? std::string(digits - text.size(), '0') + text : text;
}

}  // namespace lumen
