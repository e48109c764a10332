// SPDX-License-Identifier: Apache-2.0
// Inlets of a tree besides its root, as widths show them (docs/method.md, section 1.14).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Ratio of the radii of two vessels of which one takes twice the flow of the other, by Murray's law:
/// the cube root of two. An arm of a fork is no wider than what feeds it, and one that is less than
/// this much narrower takes over half of the flow.
inline constexpr double kHalfFlowRadii = 1.26;

/// An end at which blood comes into a tree besides its root.
struct FurtherInlet {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mm, LPS
  double radius = 0;                                 ///< mm, calibre() of its vessel there
  double narrowest = 0;  ///< mm, of the narrowest vessel between its tree's root and it
};

/// Makes ends inlets that leave the volume and that their tree cannot feed: a vessel feeds no wider
/// ones, and on the way to such an end lies one that is narrower by kHalfFlowRadii than the end, and
/// than another vessel that leaves the way behind it, where the blood of both meets. Widths on the
/// way are medians of whole stretches between two forks, outside of the lumen of both. The widest end
/// comes first; the tree is divided as by beginAt(), and the rest is looked at again. `isInside`: a
/// point, mm, LPS, lies in the volume. The case has no models.
std::vector<FurtherInlet> beginAtFurtherInlets(
    formats::Case& target, const std::function<bool(const Eigen::Vector3d&)>& isInside);

/// Reports each further inlet, with the widths that show it, as a detail.
void reportInlets(const std::vector<FurtherInlet>& inlets, Progress& progress);

}  // namespace lumen::convert
