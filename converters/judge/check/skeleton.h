// SPDX-License-Identifier: Apache-2.0
// The vessels of a group of voxels: the ways of a skeleton (docs/method.md, section 7.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// A way through voxels of a set, from where it begins to its tip.
struct SkeletonWay {
  std::vector<std::uint32_t> voxels;
  std::size_t covered = 0;  ///< voxels of the group that belong to this way and to none before it
  double length = 0;        ///< mm, from the end voxels' far sides
  double radius = 0;  ///< mm: of the cylinder of its length and volume, as far as depths allow
};

/// Splits connected groups of voxels into ways, as TEASAR does (Sato, Bitter, Bender, Kaufman,
/// Nakajima: TEASAR: tree-structure extraction algorithm for accurate and robust skeletons, 2000):
/// from the voxel that is farthest, by ways that keep to the middle, back to what is already
/// covered; the way covers what lies within one and a half times its depth and two voxels.
class Skeleton {
public:
  /// All must stay. Only voxels i with free[i] != 0 take part; they are used up.
  Skeleton(const VoxelSet& set, std::span<const float> depths, std::vector<std::uint8_t>& free)
      : m_set(set), m_depths(depths), m_free(free), m_cost(set.size()), m_from(set.size()) {}

  /// The ways of the group of `root`, the first of which begins there, that lead farther than
  /// `least` mm out of those before them. Gives the number of the group's voxels; no ways if these
  /// are fewer than `leastVoxels`.
  std::size_t split(std::uint32_t root, double least, std::size_t leastVoxels,
                    const Progress& progress, std::vector<SkeletonWay>& out);

private:
  void spread(std::uint32_t root, const Progress& progress);
  [[nodiscard]] SkeletonWay wayTo(std::uint32_t tip) const;
  void cover(SkeletonWay& way);

  const VoxelSet& m_set;
  std::span<const float> m_depths;
  std::vector<std::uint8_t>& m_free;
  std::vector<float> m_cost;          ///< of those of the group
  std::vector<std::uint32_t> m_from;  ///< the voxel before it on its way from the root
  std::vector<std::uint32_t> m_group;
};

}  // namespace lumen::convert
