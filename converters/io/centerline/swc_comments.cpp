// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/swc_comments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "converters/base/length_unit.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::convert {
namespace {

// Words of a comment on all points, of columns, and of comments on something else.
constexpr std::array<std::string_view, 8> kOnUnits = {
    "unit", "units", "position", "positions", "coordinate", "coordinates", "radii", "radius"};
constexpr std::array<std::string_view, 4> kColumnNames = {"x", "y", "z", "r"};
constexpr std::array<std::string_view, 9> kOnOthers = {
    "voxel", "voxels", "pixel", "pixels", "spacing", "separation", "resolution", "volume", "area"};
constexpr double kLargestFactor = 1e6;

template <std::size_t count>
bool isAmong(const std::string& word, const std::array<std::string_view, count>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Words and numbers, in lower case; brackets, commas and quotation marks are between them.
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

}  // namespace

void SwcComments::read(std::string_view comment) {
  readScale(comment);
  const std::string text(comment);
  readUnit(text);
  // no SWC states axes by a mere word
  if (text.find("SPACE=RAS") != text.npos) m_axes = CenterlineAxes::Ras;
  if (text.find("SPACE=LPS") != text.npos) m_axes = CenterlineAxes::Lps;
}

void SwcComments::readUnit(const std::string& comment) {
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
    if (unit) return;  // several units: of several things
    unit = named;
    unitAt = i;
  }
  if (!unit || isOnOthers || (!isOnUnits && columns < 3)) return;
  double factor = 1;
  if (unitAt > 0)
    if (const auto number = parsedNumber(words[unitAt - 1])) {
      const bool isUnit = std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return word == "unit" || word == "units";
      });
      if (!isUnit || !(*number > 0) || !(*number <= kLargestFactor)) return;
      factor = *number;
    }
  m_unit = factor * *unit;
  m_unitWords = (factor == 1 ? "" : words[unitAt - 1] + " ") + words[unitAt];
}

void SwcComments::readScale(std::string_view comment) {
  const std::vector<std::string> words = commentWords(std::string(comment));
  if (words.size() < 4 || words.front() != "scale") return;
  Eigen::Vector3d scale;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto number = parsedNumber(words[a + 1]);
    if (!number || !(*number > 0) || !(*number <= kLargestFactor)) {
      m_badScale = quotedText(std::string(comment));
      return;
    }
    scale[static_cast<Eigen::Index>(a)] = *number;
  }
  m_scale = scale;
}

void SwcComments::apply(CenterlineFile& file) const {
  if (m_unit > 0) {
    file.unit = m_unit;
    file.remarks.push_back("its comments state that lengths are in " + m_unitWords);
  }
  if (m_axes != CenterlineAxes::Unknown) file.axes = m_axes;
  if (!m_badScale.empty())
    file.remarks.push_back("its comment " + m_badScale +
                           " is no scale of three positive numbers; it is not applied");
  if (m_scale == Eigen::Vector3d::Ones()) return;
  const double ofRadius = std::cbrt(m_scale.prod());
  for (CenterlinePoint& point : file.points) {
    point.position = point.position.cwiseProduct(m_scale);
    point.radius *= ofRadius;
  }
  file.remarks.push_back("its comments state the scale " + spacingText(m_scale) +
                         ": positions are multiplied by it, and radii by " + shownNumber(ofRadius));
}

}  // namespace lumen::convert
