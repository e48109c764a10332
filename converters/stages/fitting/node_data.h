// SPDX-License-Identifier: Apache-2.0
// What the fit of one node is given. All lengths are in the fit's frame (see energy.h).
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
  std::span<const formats::Vec3d> points;  ///< of its neighbourhood
  double radius = 0;
  formats::Vec3d direction;  ///< unit vector along the vessel
  /// Inscribed balls of the neighbourhood: the centre of every blob stays in one of them. Where the
  /// points end, a wide blob out there would fit them as well as a good one. If empty, blobs stay
  /// close to the points.
  std::span<const Ball> lumen = {};
  /// The model to begin with; if empty, two blobs along the direction.
  std::span<const Blob> start = {};
  /// Of the radius: how wide the finest bulges of the wall are. A tube's wall has none, a sac's may.
  double bulges = 1;
};

/// Fewer points than this say less than the two blobs that the fit begins with.
constexpr std::size_t kFewestPoints = 8;

}  // namespace lumen::convert::fitting
