// SPDX-License-Identifier: Apache-2.0
#include "converters/base/options/option_value.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/text.h"

namespace lumen {

std::string foundText(const std::string& text, const std::string& expected) {
  return "found " + (text.empty() ? "nothing" : text) + ", expected " + expected;
}

bool NumberRange::holds(double value) const {
  return std::isfinite(value) && (openLow ? value > low : value >= low) &&
         (openHigh ? value < high : value <= high);
}

std::string NumberRange::text() const {
  const bool bounded = high != std::numeric_limits<double>::max();
  if (bounded && !openLow && !openHigh)
    return "a number from " + numberText(low) + " to " + numberText(high);
  std::string text =
      "a number " + (openLow ? "above " : std::string("of at least ")) + numberText(low);
  if (bounded) text += (openHigh ? " and below " : " and at most ") + numberText(high);
  return text;
}

std::string WholeRange::text() const {
  return "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
}

ValueCheck checkAmong(std::vector<std::string> words) {
  return [words = std::move(words)](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    return foundText(text, alternatives(words)) + didYouMean(text, words);
  };
}

bool isAddress(std::string_view text) {
  const std::size_t scheme = text.find("://");
  return scheme != std::string_view::npos && scheme > 0 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(scheme),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; });
}

ValueCheck fileName() {
  return [](const std::string& text) -> std::string {
    if (text.empty()) return "the name of a file is empty; is a variable of the shell not set?";
    if (isAddress(text)) return kAddressFault;
    if (text != "-") return {};
    return "found -, expected the name of a file; lumen neither reads standard input nor writes "
           "files to standard output (./- is a file of that name)";
  };
}

}  // namespace lumen
