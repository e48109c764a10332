// SPDX-License-Identifier: Apache-2.0
#include "converters/base/options/stated_unit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "converters/base/length_unit.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/text.h"

namespace lumen::convert {
namespace {

// Words of a comment on all points, of columns, and of comments on something else.
constexpr std::array<std::string_view, 8> kOnUnits = {
    "unit", "units", "position", "positions", "coordinate", "coordinates", "radii", "radius"};
constexpr std::array<std::string_view, 4> kColumnNames = {"x", "y", "z", "r"};
constexpr std::array<std::string_view, 9> kOnOthers = {
    "voxel", "voxels", "pixel", "pixels", "spacing", "separation", "resolution", "volume", "area"};
constexpr double kMostOfUnit = 1e6;  // times a unit

template <std::size_t count>
bool isAmong(const std::string& word, const std::array<std::string_view, count>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::vector<std::string> commentWords(const std::string& text) {
  std::vector<std::string> words;
  constexpr const char* kBetween = " \t\r,;:=()[]{}\"'/|";
  for (std::size_t from = 0; from < text.size();) {
    from = std::min(text.find_first_not_of(kBetween, from), text.size());
    const std::size_t end = std::min(text.find_first_of(kBetween, from), text.size());
    if (end > from) words.push_back(lowerCase(text.substr(from, end - from)));
    from = end;
  }
  return words;
}

std::optional<StatedUnit> unitInComment(const std::string& comment) {
  const std::vector<std::string> words = commentWords(comment);
  bool isOnUnits = false, isOnOthers = false;
  std::size_t columns = 0, unitAt = 0;
  std::optional<double> unit;
  for (std::size_t i = 0; i < words.size(); ++i) {
    isOnUnits = isOnUnits || isAmong(words[i], kOnUnits);
    isOnOthers = isOnOthers || isAmong(words[i], kOnOthers);
    columns += isAmong(words[i], kColumnNames) ? 1 : 0;
    // "in" is a word of a sentence more often than an inch
    const std::optional<double> named = words[i] == "in" ? std::nullopt : millimetresPer(words[i]);
    if (!named || (unit && *unit == *named)) continue;
    if (unit) return {};  // several units: of several things
    unit = named;
    unitAt = i;
  }
  if (!unit || isOnOthers || (!isOnUnits && columns < 3)) return {};
  const auto number = unitAt > 0 ? parsedNumber(words[unitAt - 1]) : std::nullopt;
  if (!number) return StatedUnit{*unit, words[unitAt]};
  const bool isUnit = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "unit" || word == "units";
  });
  if (!isUnit || !(*number > 0) || !(*number <= kMostOfUnit)) return {};
  return StatedUnit{*number * *unit, (*number == 1 ? "" : words[unitAt - 1] + " ") + words[unitAt]};
}

}  // namespace lumen::convert
