// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/swc_comments.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "converters/base/options/parsed_number.h"
#include "converters/base/options/stated_unit.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::convert {
namespace {

constexpr double kLargestFactor = 1e6;

}  // namespace

void SwcComments::read(std::string_view comment) {
  readScale(comment);
  const std::string text(comment);
  if (const std::optional<StatedUnit> unit = unitInComment(text)) {
    m_unit = unit->millimetres;
    m_unitWords = unit->words;
  }
  // no SWC states axes by a mere word
  if (text.find("SPACE=RAS") != text.npos) m_axes = CenterlineAxes::Ras;
  if (text.find("SPACE=LPS") != text.npos) m_axes = CenterlineAxes::Lps;
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
    file.remarks.push_back(StatedUnit{m_unit, m_unitWords}.sentence());
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
