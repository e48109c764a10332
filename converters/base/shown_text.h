// SPDX-License-Identifier: Apache-2.0
// Texts and points of files, as they appear in messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/base/number_text.h"
#include "formats/container/printable.h"

namespace lumen::convert {

/// A text of a file between quotes, short enough for a sentence.
inline std::string quotedText(const std::string& text) {
  std::size_t shown = 80;  // bytes
  if (text.size() <= shown) return std::string("\"").append(formats::printable(text)).append("\"");
  while (shown > 0 && (static_cast<unsigned char>(text[shown]) & 0xC0U) == 0x80U) --shown;
  return std::string("\"").append(formats::printable(text.substr(0, shown))).append("...\"");
}

/// "(1, 2.5, 3)", each number with at most `digits` significant digits.
inline std::string vectorText(const Eigen::Vector3d& v, int digits = 6) {
  return std::string("(").append(joinedNumbers(v, ", ", digits)).append(")");
}

/// "(1.0, 2.5, 3.0)", a place whose coordinates have `decimals` decimals.
inline std::string placeText(const Eigen::Vector3d& place, int decimals = 1) {
  std::string text = "(";
  text.append(fixedText(place.x(), decimals)).append(", ");
  text.append(fixedText(place.y(), decimals)).append(", ");
  return text.append(fixedText(place.z(), decimals)).append(")");
}

/// A word as a shell reads it: in quotes where it has more than letters, digits and -_./+:,=%@.
inline std::string shellWord(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+:,=%@";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// A command as a shell reads it.
inline std::string shellLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words)
    line.append(line.empty() ? "" : " ").append(shellWord(word));
  return line;
}

/// "0.5 x 0.5 x 1", each number with at most `digits` significant digits.
inline std::string spacingText(const Eigen::Vector3d& spacing, int digits = 6) {
  return joinedNumbers(spacing, " x ", digits);
}

}  // namespace lumen::convert

namespace lumen {

// Final clean-up of a message for a person.

/// `message` for a terminal: each of its lines is printable and has no object addresses, which
/// libraries put into their messages ("NrrdImageIO(0x55d0c0ffee00): ") and which differ from run to
/// run.
std::string messageText(std::string_view message);

}  // namespace lumen
