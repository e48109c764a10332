// SPDX-License-Identifier: Apache-2.0
// The voxels of an aneurysm: its lumen with all lobes, up to the vessels that it opens into
// (docs/method.md, section 1.7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"
#include "converters/voxels/cell_box.h"

namespace lumen::convert {

struct SacRegion {
  CellBox box;
  std::vector<float> depth;         ///< mm from the nearest voxel outside of any lumen; there 0
  std::vector<std::uint8_t> isSac;  ///< 1: of the sac, and no vessel's

  /// The depth at the voxel nearest to a place in index space; empty outside of the box.
  [[nodiscard]] std::optional<float> depthAt(const Eigen::Vector3d& index) const {
    const auto cell = box.nearest(index);
    return cell ? std::optional(depth[box.index(*cell)]) : std::nullopt;
  }
};

/// A ball around a click that lies in the sac, mm, LPS.
struct SacBall {
  Eigen::Vector3d centre;
  double radius;
};

/// Distance of the farthest wall that belongs to a ball's sac, in radii of the ball, as on rays
/// (rays.h).
constexpr double kSacReach = 2.4;

/// Half of the width of a passage that continues within the sac of some balls, mm.
double leastPassage(std::span<const SacBall> balls);

/// The voxels of a sac: brighter than `wallLevel` (darker, for dark vessels), in no vessel, and
/// joined to the balls' centres by passages at least half of the least ball's radius wide, up to
/// kSacReach radii from one of them. Holes within the lumen belong to it. `inVessel`: for places in
/// LPS mm. Empty if no ball holds any, or if the box around them has too many voxels. Throws
/// Error(Cancelled).
std::optional<SacRegion> growSac(const TrackContext& context, double wallLevel,
                                 std::span<const SacBall> balls,
                                 const std::function<bool(const Eigen::Vector3d&)>& inVessel);

/// Points on the wall of a region, where the intensity falls fastest across it, with the strength
/// of that fall, voxel units per mm; one for each of its voxels that has one outside beside it.
struct SacWall {
  std::vector<Eigen::Vector3d> points;  ///< mm, LPS
  std::vector<double> strength;
};
SacWall measureSacWall(const TrackContext& context, const SacRegion& region);

/// A subset of the points whose members are at least `apart` mm from each other, such that each of
/// `points` has a member at most as far away.
std::vector<Eigen::Vector3d> thinnedOut(std::span<const Eigen::Vector3d> points, double apart);

}  // namespace lumen::convert
