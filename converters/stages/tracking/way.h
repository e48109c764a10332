// SPDX-License-Identifier: Apache-2.0
// Ways through the volume that keep to the lumen: minimal paths (L. Cohen, R. Kimmel, "Global minimum
// for active contour models: a minimal path approach", 1997).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/lumen_price.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/voxels/cube_search.h"

namespace lumen::convert {

/// Medians over nodes: of the intensity at their centres, and at their wall points. Both zero if
/// none has wall points.
LumenLevels levelsOf(const BsplineVolume& volume, std::span<const TrackedNode> nodes);

struct Way {
  std::vector<Eigen::Vector3d> points;  ///< from the start, mm, LPS, smoothed
  double length = 0;                    ///< mm
  double outside = 0;                   ///< of the length: darker than the wall, mm
  std::size_t goal = 0;                 ///< where it ends, as an index of the goals
  double breadth = 0;  ///< onward: radius of a disc as large as the lumen where it ends, mm
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

/// Where ways begin, and what they keep away from.
struct Outset {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ();
  std::vector<Ball> closed;  ///< no way leads here
  std::vector<Ball> behind;  ///< nor here, as far as it lies behind the plane through the place
  std::vector<Ball> others;  ///< other vessels: a way may cross them once, ...
  double through = 0;        ///< ... if it enters them within so many mm
};

struct WaysOnward {
  std::vector<Way> ways;  ///< one to each part of the lumen at that distance, the cheapest first
  double visible = 0;     ///< mm along the lumen to its farthest place, at most the distance
  bool isAll = true;      ///< nothing leads farther than the distance, not even in another vessel
};

/// The ways within the lumen to everything that is `distance` mm of way from a place: where the
/// lumen forks there are several, where it ends before there is none. Those through another vessel
/// end ahead of the place. Throws Error(Cancelled).
WaysOnward waysOnward(const TrackContext& context, const LumenLevels& levels, const Outset& outset,
                      double distance);

}  // namespace lumen::convert
