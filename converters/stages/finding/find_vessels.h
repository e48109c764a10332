// SPDX-License-Identifier: Apache-2.0
// The vessels of a whole volume, found without a click (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/voxels/cube_search.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Courses of vessels, and the voxels that they run through.
struct FoundVessels {
  VolumeGeometry geometry;
  std::vector<std::size_t> lumen;  ///< indices of voxels, ascending
  std::vector<std::size_t> bone;   ///< the same, of bright tissue that is no vessel
  std::vector<SeedBranch> courses;

  /// Whether the voxel around a point, mm, LPS, is one of these.
  [[nodiscard]] bool isLumen(const Eigen::Vector3d& point) const { return isIn(lumen, point); }
  [[nodiscard]] bool isBone(const Eigen::Vector3d& point) const { return isIn(bone, point); }

private:
  [[nodiscard]] bool isIn(const std::vector<std::size_t>& voxels,
                          const Eigen::Vector3d& point) const;
};

/// The courses of all vessels that a volume shows: one seed for each, parents first, whose points
/// with their radii lie along it, from its parent's axis to its tip. Vessels that are connected are
/// one tree, from the tip of its widest vessel. An aneurysm's points are inside of it. Radii are as
/// coarse as the voxels; the tracker measures them. `dark`: vessels are darker than their
/// background. Throws Error(Cancelled).
FoundVessels findVessels(const Volume& volume, bool dark, Progress& progress);

/// The courses through the lumen outside of `vessels`, in the form of findVessels(), which may
/// follow only one of two vessels that touch. `vessels`: balls along the vessels in the frame of
/// gridGeometry(). A voxel belongs to the vessels up to a voxel beyond a ball. Throws
/// Error(Cancelled).
std::vector<SeedBranch> coursesInRemainingLumen(const FoundVessels& found,
                                                std::span<const WorldBall> vessels,
                                                Progress& progress);

}  // namespace lumen::convert
