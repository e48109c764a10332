// SPDX-License-Identifier: Apache-2.0
// The vessels of a group of voxels: the paths of a skeleton (docs/method.md, section 7.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/skeleton.h"

namespace lumen::convert {

/// A path through voxels of a set, from where it begins to its tip.
struct SkeletonPath {
  std::vector<std::uint32_t> voxels;
  std::size_t covered = 0;  ///< voxels of the group that belong to this path and to no earlier one
  double length = 0;        ///< mm, from the end voxels' far sides
  double radius = 0;        ///< mm: of the cylinder of its length and volume, limited by the depths
};

/// Splits connected groups of voxels into paths: from the voxel that is farthest, along the middle,
/// back to the voxels that are already covered. The cost of a step is its length divided by the
/// square of the depth.
class SkeletonPaths {
public:
  /// All arguments must outlive this object. Only voxels i with free[i] != 0 take part; they are
  /// used up.
  SkeletonPaths(const VoxelSet& set, std::span<const float> depths, std::vector<std::uint8_t>& free)
      : m_skeleton(set, depths, {}), m_free(free) {}

  /// The paths of the group of `root`, the first of which begins there, that extend more than
  /// `least` mm beyond earlier paths. Returns the number of the group's voxels; no paths if these
  /// are fewer than `leastVoxels`. Throws Error(Cancelled).
  std::size_t split(std::uint32_t root, double least, std::size_t leastVoxels,
                    const Progress& progress, std::vector<SkeletonPath>& out);

private:
  [[nodiscard]] SkeletonPath pathTo(std::uint32_t tip) const;
  void cover(SkeletonPath& path);

  Skeleton m_skeleton;
  std::vector<std::uint8_t>& m_free;
};

}  // namespace lumen::convert
