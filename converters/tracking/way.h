// SPDX-License-Identifier: Apache-2.0
// The way through the volume from one place to another that keeps to the lumen: a minimal path
// (L. Cohen, R. Kimmel, "Global minimum for active contour models: a minimal path approach", 1997).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/tracking/node_fit.h"

namespace lumen::convert {

/// Intensities, bright or dark as the vessels are: of the lumen's middle, and halfway down its wall.
struct LumenLevels {
  double middle = 0, wall = 0;
};

/// Medians over nodes: of the intensity at their centres, and at their wall points.
LumenLevels levelsOf(const BsplineVolume& volume, std::span<const TrackedNode> nodes);

struct Way {
  std::vector<Eigen::Vector3d> points;  ///< from start to goal, mm, LPS, smoothed
  double length = 0;                    ///< mm
  double outside = 0;                   ///< of the length: darker than the wall, mm
  std::size_t goal = 0;                 ///< where it ends, as an index of the goals
};

/// Where a way may end.
struct Goal {
  Eigen::Vector3d position;  ///< mm, LPS
  double surcharge = 0;      ///< mm: how much farther another goal may be and still be preferred
};

/// The cheapest way from `start` to one of `goals`, on the lattice of the voxels, where a
/// millimetre that is darker than the lumen's middle costs more, and one beyond the wall's level
/// much more. Empty if no goal is within `reach` mm of the start. Throws Error(Cancelled).
std::optional<Way> findWay(const TrackContext& context, const LumenLevels& levels,
                           const Eigen::Vector3d& start, std::span<const Goal> goals, double reach);

}  // namespace lumen::convert
