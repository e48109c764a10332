// SPDX-License-Identifier: Apache-2.0
// The vessels of a whole volume, found without a click (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/finding/bone_rim.h"
#include "converters/stages/finding/prior.h"
#include "converters/voxels/cube_search.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Courses of vessels, and the voxels that they run through.
struct FoundVessels {
  VolumeGeometry geometry;
  std::vector<std::size_t> lumen;  ///< indices of voxels, ascending
  /// The system of vessels of each of these, as a prior has them; empty if there is one.
  std::vector<std::uint8_t> systems;
  std::vector<std::size_t> bone;  ///< the same, of bright tissue that is no vessel
  bool isBoneKnown = false;       ///< levels of tissue show it, as in computed tomography
  /// The volume with its image continued; null if all is image. Kept for `rim`.
  std::shared_ptr<const Volume> continued;
  std::shared_ptr<const Volume> folded;  ///< of BrightVoxels
  std::shared_ptr<const BoneRim> rim;    ///< the same
  std::vector<SeedBranch> courses;

  /// The volume to track the courses in, of that in which they were found.
  [[nodiscard]] const Volume& tracked(const Volume& whole) const {
    return folded ? *folded : continued ? *continued : whole;
  }

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
/// background. No course leads from one system of `prior` to another; lumen of which it says
/// nothing belongs to the system from which the widest way leads there. Throws Error(Cancelled).
FoundVessels findVessels(const Volume& volume, bool dark, const Prior& prior, Progress& progress);

/// The courses through the lumen outside of `vessels`, in the form of findVessels(), which may
/// follow only one of two vessels that touch. `vessels`: balls along the vessels in the frame of
/// gridGeometry(). A voxel belongs to the vessels up to a voxel beyond a ball. Throws
/// Error(Cancelled).
std::vector<SeedBranch> coursesInRemainingLumen(const FoundVessels& found,
                                                std::span<const WorldBall> vessels,
                                                Progress& progress);

}  // namespace lumen::convert
