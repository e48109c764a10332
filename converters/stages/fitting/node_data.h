// SPDX-License-Identifier: Apache-2.0
// Input of the fit of one node. All lengths are in the fit's frame (see energy.h).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "converters/stages/fitting/energy.h"
#include "converters/stages/fitting/levenberg_marquardt.h"

namespace lumen::convert::fitting {

struct LocalModelOptions {
  EnergyParameters energy;
  int maxSubdivisions = 100;  ///< N_s
  double accuracy = 0.3;      ///< t_g
  double maxDistance = 20;    ///< blobs farther than this from the node are dropped
  double minWidth = 0.02;     ///< narrower blobs are dropped
};

/// A node at the origin.
struct NodeData {
  std::span<const formats::Vec3d> points;  ///< points of its neighbourhood
  double radius = 0;
  formats::Vec3d direction;  ///< unit vector along the vessel
  /// Inscribed balls of the neighbourhood: the centre of every blob stays in one of them. Where the
  /// points end, a wide blob out there would fit them as well as a good one. If empty, blobs stay
  /// close to the points.
  std::span<const FitBall> lumen = {};
  /// Starting model; if empty, two blobs along the direction.
  std::span<const Blob> start = {};
  /// Radius of the wall's finest bulges, as a share of the radius. A tube's wall has none, a sac's
  /// may.
  double bulges = 1;
};

/// Least number of points: fewer determine less than the two blobs that the fit begins with.
constexpr std::size_t kFewestPoints = 8;

}  // namespace lumen::convert::fitting
