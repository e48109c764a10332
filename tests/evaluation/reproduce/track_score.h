// SPDX-License-Identifier: Apache-2.0
// One tracking of a phantom, scored branch by branch and node by node.
#pragma once

#include <string>
#include <vector>

#include "converters/judge/compare/compare.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::reproduce {

/// Outcome for a vessel of the truth.
struct BranchOutcome {
  std::string label;
  double radius = 0;  ///< mean of the true nodes, voxels
  double length = 0;  ///< true, mm
  bool started = false;
  bool leaked =
      false;  ///< a node lies outside its own vessel, in another one that is no child of it
  convert::CenterlineScore score;
};

/// Outcome for a node of a tracked vessel; first nodes in the true parent's lumen are left out.
struct NodeOutcome {
  double trueRadius = 0;   ///< at the nearest point of the true branch, voxels
  double radiusError = 0;  ///< found minus true, voxels
  double centreError = 0;  ///< distance to the true centerline of the branch, voxels
  double inlierRate = 0;
};

struct TrackOutcome {
  double voxel = 0;        ///< mm
  double pointSpread = 0;  ///< mm, by which the walls were corrected
  convert::CenterlineScore score;
  std::vector<BranchOutcome> branches;
  std::vector<NodeOutcome> nodes;
};

/// Tracks from the phantom's clicks.
TrackOutcome trackAndScore(const convert::Phantom& phantom, Progress& progress,
                           const convert::TrackOptions& options = {});

/// Errors of the clicks on vessels. Directions and radii are those of the nearest true node.
struct ClickError {
  double offset = 0;  ///< across the vessel, in true radii
  double tilt = 0;    ///< degrees off the true direction; negative: no direction is given
  double factor =
      0;  ///< on the true radius; 0: the radius is left as it was, negative: none is given
};

/// Moves the first click of every vessel in a random direction.
void disturbClicks(convert::Phantom& phantom, const ClickError& error, std::uint64_t seed);

}  // namespace lumen::reproduce
