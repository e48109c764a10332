// SPDX-License-Identifier: Apache-2.0
// The unit of length that a comment of a file states.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lumen::convert {

struct StatedUnit {
  double millimetres = 1;  ///< in one unit of the file
  std::string words;       ///< as the comment has them, "um" or "0.5 um"

  /// A sentence for people.
  [[nodiscard]] std::string sentence() const {
    return "its comments state that lengths are in " + words;
  }
};

/// The unit of all lengths by a comment such as "units: um", "positions in nm" or "x (mm), y, z";
/// empty where it is about something else, or about several units.
std::optional<StatedUnit> unitInComment(const std::string& comment);

/// Words and numbers of a comment, in lower case; brackets, commas and quotation marks are between
/// them.
std::vector<std::string> commentWords(const std::string& text);

}  // namespace lumen::convert
