// SPDX-License-Identifier: Apache-2.0
// Paths through the volume that keep to the lumen: minimal paths (L. Cohen, R. Kimmel, "Global
// minimum for active contour models: a minimal path approach", 1997).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/track_run.h"
#include "converters/voxels/cube_search.h"

namespace lumen::convert {

/// Intensities of the lumen's middle, and halfway down its wall, bright or dark as the vessels are.
struct LumenLevels {
  double middle = 0, wall = 0;
};

/// Nodes at a place of a track from which the levels of its lumen are taken.
constexpr std::size_t kLevelNodes = 12;

/// Medians over nodes: of the intensity at their centres, and at their wall points. Both zero if
/// none has wall points.
LumenLevels measureLevels(const BsplineVolume& volume, std::span<const TrackedNode> nodes);

/// Adds balls that hold the lumen around nodes, with the blur of its rim.
void addLumen(std::span<const TrackedNode> nodes, const VolumeGeometry& geometry,
              std::vector<WorldBall>& balls);

struct Path {
  std::vector<Eigen::Vector3d> points;  ///< from the start, mm, LPS, smoothed
  double length = 0;                    ///< mm
  double outside = 0;                   ///< part of the length that is darker than the wall, mm
  std::size_t goal = 0;                 ///< index of the goal at its end
  /// radius of a disc as large as the lumen at its end, mm; of paths beyond a place only
  double breadth = 0;
};

/// A place at which a path may end.
struct PathGoal {
  Eigen::Vector3d position;  ///< mm, LPS
  double surcharge = 0;      ///< mm that another goal may be farther away and still be preferred
};

/// The cheapest path from `start` to one of `goals`, on the lattice of the voxels, where a
/// millimetre that is darker than the lumen's middle costs more, and one beyond the wall's level
/// much more. Empty if no goal is within `reach` mm of the start. Throws Error(Cancelled).
std::optional<Path> findPath(const TrackContext& context, const LumenLevels& levels,
                             const Eigen::Vector3d& start, std::span<const PathGoal> goals,
                             double reach);

/// The start of paths, and the obstacles that they keep away from.
struct PathStart {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ();
  std::vector<WorldBall> closed;  ///< no path leads into these
  std::vector<WorldBall> behind;  ///< nor into the part of these behind the plane through the place
  std::vector<WorldBall> others;  ///< other vessels: a path may cross them once, ...
  double through = 0;             ///< ... if it enters them within this length, mm
};

struct PathsBeyond {
  std::vector<Path> paths;  ///< one to each part of the lumen at that distance, the cheapest first
  double visible = 0;       ///< mm along the lumen to its farthest place, at most the distance
  bool isAll = true;        ///< the lumen ends within the distance, other vessels included
};

/// The paths within the lumen to every part of it that is `distance` mm of path from a place:
/// several where the lumen forks, none where it ends before. Paths through another vessel end ahead
/// of the place. Throws Error(Cancelled).
PathsBeyond pathsBeyond(const TrackContext& context, const LumenLevels& levels,
                        const PathStart& start, double distance);

}  // namespace lumen::convert
