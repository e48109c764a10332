// SPDX-License-Identifier: Apache-2.0
// Voxels that a person can count.
#include "converters/judge/check/skeleton_paths.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "converters/voxels/depth.h"

namespace lumen::convert {
namespace {

VolumeGeometry gridOf(int edge, double spacing) {
  VolumeGeometry geometry;
  geometry.size = {edge, edge, edge};
  geometry.spacing.setConstant(spacing);
  return geometry;
}

std::vector<SkeletonPath> pathsOf(const VoxelSet& set, std::size_t root, std::size_t least) {
  const std::vector<float> depths = measureDepths(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, Progress());
  std::vector<std::uint8_t> free(set.size(), 1);
  std::vector<SkeletonPath> paths;
  SkeletonPaths skeleton(set, depths, free);
  skeleton.split(set.find(root), 4 * set.geometry().voxelSize(), least, Progress(), paths);
  return paths;
}

/// Twenty voxels in a row, and ten more across it from its middle.
std::vector<std::size_t> fork(const VolumeGeometry& geometry) {
  std::vector<std::size_t> voxels;
  for (int x = 0; x < 20; ++x) voxels.push_back(geometry.index({x, 2, 2}));
  for (int y = 3; y < 13; ++y) voxels.push_back(geometry.index({9, y, 2}));
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST(SkeletonPaths, AForkHasTwoPaths) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  const auto paths = pathsOf(set, geometry.index({0, 2, 2}), 20);
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_NEAR(paths[0].length, 20 * 0.3, 0.3);
  EXPECT_EQ(set.index(paths[0].voxels.front()), geometry.index({0, 2, 2}));
  EXPECT_EQ(set.index(paths[0].voxels.back()), geometry.index({19, 2, 2}));
  // less what the first path covers: two voxels and three quarters
  EXPECT_NEAR(paths[1].length, 8 * 0.3, 0.35);
  EXPECT_EQ(set.index(paths[1].voxels.back()), geometry.index({9, 12, 2}));
  EXPECT_EQ(paths[0].covered + paths[1].covered, 30U);
}

TEST(SkeletonPaths, ASpeckHasNone) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  EXPECT_TRUE(pathsOf(set, geometry.index({0, 2, 2}), 31).empty());
}

}  // namespace
}  // namespace lumen::convert
