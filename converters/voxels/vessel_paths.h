// SPDX-License-Identifier: Apache-2.0
// The vessels of a set of voxels as a tree of paths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/skeleton.h"

namespace lumen::convert {

/// A path through the middle of the lumen.
struct VesselPath {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> voxels;  ///< from where it begins, on its parent's path, to its tip
  std::uint32_t parent = kNone;       ///< a path before this one
  std::size_t parentVoxel = 0;        ///< index of the parent's voxel that it begins at
  std::uint32_t meets = kNone;  ///< a path before this one whose lumen its tip lies in: a loop
  std::size_t meetsVoxel = 0;   ///< index of that path's voxel nearest to the tip
  bool isSac = false;           ///< it widens beyond a neck and ends there
};

/// Paths of one connected part of a set of voxels, as a skeleton of them, on which a step costs its
/// length by the fourth power of the depth.
class VesselPaths {
public:
  /// True if no wall lies between two places.
  using IsOpen = std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>;
  /// A path that extends less than this many of its parent's depths beyond that vessel is a corner
  /// of it or a bump on it.
  static constexpr double kLeastOfParent = 0.5;
  /// All must stay; fewer than 2^29 voxels. `depths`: mm from each to the wall. Throws
  /// Error(Cancelled).
  VesselPaths(const VoxelSet& set, std::span<const float> depths, const IsOpen& isOpen,
              const Progress& progress, double leastOfParent = kLeastOfParent);

  /// The paths of the connected part of `root`, where the first begins. A path is kept if its
  /// length outside of the balls of those before it is more than its width; or if it widens behind
  /// a neck by a fifth, as a sac does. Throws Error(Cancelled).
  std::vector<VesselPath> find(std::uint32_t root, const Progress& progress);

  /// Adds the path to `tip`, however short it is, to those that find() found in its part. False if
  /// another path runs through it.
  bool addPath(std::uint32_t tip, std::vector<VesselPath>& paths);

  /// The voxels of a connected part; the given one is the first.
  [[nodiscard]] std::vector<std::uint32_t> connectedPart(std::uint32_t voxel) const;

  /// The voxel farthest from `from`, in its part.
  std::uint32_t farthest(std::uint32_t from, const Progress& progress);

  /// The tip of the widest vessel in the part of `voxel`, where that vessel enters it.
  std::uint32_t widestTip(std::uint32_t voxel, const Progress& progress);

private:
  enum Cover : std::uint8_t { kFree = 0, kNearBall = 1, kInBall = 2 };
  /// A voxel that shares a corner with another, with no wall in between; in the upper three bits
  /// the axes along which it lies beside it.
  using Step = std::uint32_t;
  static constexpr std::size_t kMostSteps = 26;
  static constexpr Step kNoStep = 0;
  static constexpr int kAxesShift = 29;
  static std::uint32_t voxelOf(Step step) { return step & ((1U << kAxesShift) - 1); }
  template <class Visit>
  void eachStep(std::uint32_t i, Visit&& visit) const {
    for (std::size_t k = kMostSteps * i; k < kMostSteps * (i + 1) && m_steps[k] != kNoStep; ++k)
      visit(voxelOf(m_steps[k]), m_lengthOf[m_steps[k] >> kAxesShift]);
  }
  void findSteps(const Progress& progress);
  /// The least depth of a path from where the greatest ball at its first voxel ends to a few depths
  /// on, mm.
  [[nodiscard]] double widthAtStart(const std::vector<std::uint32_t>& voxels) const;
  void spread(std::uint32_t root, const Progress& progress);
  [[nodiscard]] VesselPath pathTo(std::uint32_t tip) const;
  /// Whether the ball around a voxel reaches a face of the volume.
  [[nodiscard]] bool leavesVolume(std::uint32_t tip) const;
  /// The greatest depth of the paths within the ball around a voxel, mm.
  [[nodiscard]] double widthAround(std::uint32_t i) const;
  [[nodiscard]] bool isVessel(VesselPath& path) const;
  void findLoop(VesselPath& path) const;
  void cover(const VesselPath& path);
  void append(VesselPath path, std::vector<VesselPath>& paths);
  void coverAround(std::uint32_t i, bool isBall);
  [[nodiscard]] bool isOpen(std::uint32_t i, std::uint32_t j) const;
  [[nodiscard]] double depth(std::uint32_t i) const {
    return static_cast<double>(m_skeleton.depth(i));
  }
  /// Radii of the balls around two voxels, together.
  [[nodiscard]] double depths(std::uint32_t i, std::uint32_t j) const {
    return static_cast<double>(m_skeleton.depth(i) + m_skeleton.depth(j));
  }

  const VoxelSet& m_set;
  const IsOpen& m_isOpen;
  Skeleton m_skeleton;
  std::vector<Step> m_steps;          ///< kMostSteps for each voxel, kNoStep behind the last
  std::array<float, 8> m_lengthOf{};  ///< mm of a step, by the bits of its axes
  double m_leastOfParent;
  std::vector<std::uint8_t> m_cover;
  std::vector<std::uint32_t> m_path;   ///< for each voxel on a path, the index of the path
  std::vector<std::uint32_t> m_place;  ///< for each voxel on a path, its position on it
};

}  // namespace lumen::convert
