// SPDX-License-Identifier: Apache-2.0
// How much of the clicked vessels a case holds, and how much else. Labels do not matter: a vessel is
// covered by whatever passes through it.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::reproduce {

/// A stretch of an axis.
struct AxisPiece {
  std::string branch;              ///< its label
  double from = 0, to = 0;         ///< mm along the branch
  double length = 0;               ///< mm
  Eigen::Vector3d place{0, 0, 0};  ///< where it begins, mm, LPS
  double radius = 0;               ///< mean, mm
};

/// Lengths in mm.
struct VesselScore {
  double clicked = 0;  ///< true length of the clicked vessels
  double covered = 0;  ///< of that, where an axis of the case passes within the true radius
  double thin = 0;     ///< of what is not covered, with a radius below 1.5 voxels
  double length = 0;   ///< of the case's axes
  double falseLength =
      0;  ///< of that, farther than half a voxel from the lumen of every true vessel
  double reachable = 0, reachableOf = 0;    ///< formats::measureReachability()
  double wallMedian = 0, radiusBias = 0;    ///< convert::compareCases()
  std::vector<AxisPiece> uncovered, wrong;  ///< longest first
};

/// `clicked`: labels of true branches. Aneurysms do not count among them: their axis is a
/// convention. An axis of the case is the line between a node and its parent, or between two nodes
/// that are linked.
VesselScore scoreVessels(const formats::Case& found, const formats::Case& truth,
                         const std::set<std::string>& clicked, Progress& progress);

}  // namespace lumen::reproduce
