// SPDX-License-Identifier: Apache-2.0
// Names of length units in files.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "converters/base/text.h"

namespace lumen::convert {

/// Millimetres of the unit `name`, such as "mm", "Metres" or "um"; empty if it is unknown.
inline std::optional<double> millimetresPer(const std::string& name) {
  static const std::map<std::string, double> known = {{"mm", 1},
                                                      {"millimeter", 1},
                                                      {"millimetre", 1},
                                                      {"cm", 10},
                                                      {"centimeter", 10},
                                                      {"centimetre", 10},
                                                      {"dm", 100},
                                                      {"m", 1000},
                                                      {"meter", 1000},
                                                      {"metre", 1000},
                                                      {"um", 1e-3},
                                                      {"\xc2\xb5m", 1e-3},
                                                      {"\xce\xbcm", 1e-3},
                                                      {"\xb5m", 1e-3},
                                                      {"micron", 1e-3},
                                                      {"micrometer", 1e-3},
                                                      {"micrometre", 1e-3},
                                                      {"nm", 1e-6},
                                                      {"nanometer", 1e-6},
                                                      {"nanometre", 1e-6},
                                                      {"in", 25.4},
                                                      {"inch", 25.4}};
  std::string word = lowerCase(trimmed(name));
  auto found = known.find(word);
  if (found == known.end() && word.size() > 4 && word.back() == 's') {
    word.pop_back();
    found = known.find(word);
  }
  if (found == known.end()) return {};
  return found->second;
}

/// Words of a file on its axes, as 3D Slicer and others write them: "RAS", "SPACE=LPS",
/// "right-anterior-superior".
enum class StatedAxes : unsigned char { None, Lps, Ras };

inline StatedAxes axesIn(const std::string& text) {
  const std::string word = lowerCase(text);
  const auto has = [&](const char* words) { return word.find(words) != word.npos; };
  if (word == "ras" || has("space=ras") || has("right-anterior-superior")) return StatedAxes::Ras;
  if (word == "lps" || has("space=lps") || has("left-posterior-superior")) return StatedAxes::Lps;
  return StatedAxes::None;
}

}  // namespace lumen::convert
