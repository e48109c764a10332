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

namespace lumen::convert {

/// A box of a volume's voxels, x fastest.
struct VoxelBox {
  Eigen::Vector3i low = Eigen::Vector3i::Zero(), size = Eigen::Vector3i::Zero();

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] bool holds(const Eigen::Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size.array()).all();
  }
  [[nodiscard]] std::size_t place(const Eigen::Vector3i& cell) const;
  [[nodiscard]] Eigen::Vector3i cell(std::size_t place) const;
  /// Of a cell, in the volume's index space.
  [[nodiscard]] Eigen::Vector3d index(const Eigen::Vector3i& cell) const {
    return (cell + low).cast<double>();
  }
  /// The cell whose voxel is nearest to an index position; empty if the box has none there.
  [[nodiscard]] std::optional<std::size_t> at(const Eigen::Vector3d& index) const;
};

struct SacRegion {
  VoxelBox box;
  std::vector<float> depth;         ///< mm from the nearest voxel outside of any lumen; there 0
  std::vector<std::uint8_t> isSac;  ///< 1: of the sac, and no vessel's
};

/// A ball around a click that lies in the sac, mm, LPS.
struct SacBall {
  Eigen::Vector3d centre;
  double radius;
};

/// Radii of a ball: the farthest wall that belongs to the same sac, as on rays (rays.h).
constexpr double kSacReach = 2.4;

/// Half of the width of a way that leads on within the sac of some balls, mm.
double leastPassage(std::span<const SacBall> balls);

/// What is brighter than `wallLevel` (darker, for dark vessels), in no vessel, and joined to the
/// balls' centres by ways at least half of the least ball's radius wide, up to kSacReach radii from
/// one of them. Holes within the lumen belong to it. `inVessel`: for places in LPS mm. Empty if no
/// ball holds any, or if the box around them has too many voxels. Throws Error(Cancelled).
std::optional<SacRegion> growSac(const TrackContext& context, double wallLevel,
                                 std::span<const SacBall> balls,
                                 const std::function<bool(const Eigen::Vector3d&)>& inVessel);

/// Points on the wall of a region, where the intensity falls fastest across it, with the strength
/// of that fall, voxel units per mm; one for each of its voxels that has one outside beside it.
struct SacWall {
  std::vector<Eigen::Vector3d> points;  ///< mm, LPS
  std::vector<double> strength;
};
SacWall wallOf(const TrackContext& context, const SacRegion& region);

/// Points that are at least `apart` mm from each other, so many that each of `points` has one at
/// most as far away.
std::vector<Eigen::Vector3d> thinnedOut(std::span<const Eigen::Vector3d> points, double apart);

}  // namespace lumen::convert
