// SPDX-License-Identifier: Apache-2.0
// Ranges and checks of the value of an option.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lumen {

/// Range of an option's number, ends included unless they are open.
struct NumberRange {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool openLow = false, openHigh = false;

  [[nodiscard]] bool holds(double value) const;
  /// "a number from 0 to 1", "a number above 0 and at most 2", "a number of at least 0".
  [[nodiscard]] std::string text() const;
};

/// Range of an option's whole number, ends included.
struct WholeRange {
  std::int64_t low = 0;
  std::int64_t high = std::numeric_limits<std::int32_t>::max();

  /// "a whole number from 0 to 100".
  [[nodiscard]] std::string text() const;
};

/// A kilometre in mm: no length in a body is as great.
constexpr double kLongest = 1e6;
constexpr NumberRange kPositive{0, kLongest, true};
constexpr NumberRange kNotNegative{0, kLongest};

/// A fault of one value as the end of a sentence, "found 2, expected a number from 0 to 1", or
/// empty.
using ValueCheck = std::function<std::string(const std::string&)>;

/// "found 2, expected a number from 0 to 1", or "found nothing, ..." for an empty text.
std::string foundText(const std::string& text, const std::string& expected);
/// One of the given words. A misspelt word gets a "did you mean".
ValueCheck checkAmong(std::vector<std::string> words);
/// Whether a text is an address instead of a file's name, such as "https://example.org/head.nrrd".
bool isAddress(std::string_view text);
/// The fault of an address. It does not repeat it, as an address may hold a password.
inline constexpr const char* kAddressFault =
    "found an address, expected the name of a file; lumen reads files: fetch it first, such as by "
    "curl -O or rclone copy";
/// A name of a file or folder: not empty, no address, and not "-", which other programs take for a
/// stream.
ValueCheck fileName();

}  // namespace lumen
