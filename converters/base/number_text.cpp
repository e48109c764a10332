// SPDX-License-Identifier: Apache-2.0
#include "converters/base/number_text.h"

#include <array>
#include <cstdio>

namespace lumen::convert {

std::string numberText(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value == 0 ? 0.0 : value);
  return text.data();
}

std::string fixedText(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value == 0 ? 0.0 : value);
  return text.data();
}

}  // namespace lumen::convert
