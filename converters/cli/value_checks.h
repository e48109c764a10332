// SPDX-License-Identifier: Apache-2.0
// What an option takes: checks that say what was found and what is expected, and that leave nothing
// for the parser to guess.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lumen::app {

/// The numbers that an option takes, ends included unless they are open.
struct NumberRange {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool openLow = false, openHigh = false;

  [[nodiscard]] bool holds(double value) const;
  /// "a number from 0 to 1", "a number above 0 and at most 2", "a number of at least 0".
  [[nodiscard]] std::string text() const;
};

/// A decimal number in the range.
CLI::Validator numberIn(const NumberRange& range);

/// One such number, or three with commas between them.
CLI::Validator oneOrThreeIn(const NumberRange& range);

/// A whole number in decimal digits, ends included.
CLI::Validator wholeIn(std::int64_t low, std::int64_t high);

/// One of these numbers.
CLI::Validator oneOf(const std::vector<int>& numbers);

/// One of these words; a slip gets its "did you mean".
CLI::Validator oneOf(const std::vector<std::string>& words);

/// The name of a file or folder: not empty, as a shell variable that is not set is, and not "-",
/// which other programs take for a stream.
CLI::Validator fileName();

/// An option, or a positional argument, that names a file.
CLI::Option* addFile(CLI::App& app, const std::string& name, std::string& file,
                     const std::string& help);

}  // namespace lumen::app
