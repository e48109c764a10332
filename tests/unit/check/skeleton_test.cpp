// SPDX-License-Identifier: Apache-2.0
// Voxels that a person can count.
#include "converters/judge/check/skeleton.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

VolumeGeometry gridOf(int edge, double spacing) {
  VolumeGeometry geometry;
  geometry.size = {edge, edge, edge};
  geometry.spacing.setConstant(spacing);
  return geometry;
}

std::size_t at(const VolumeGeometry& geometry, int x, int y, int z) {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(geometry.size[1]) +
          static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(geometry.size[0]) +
         static_cast<std::size_t>(x);
}

std::vector<float> depthsIn(const VoxelSet& set) {
  return depthsOf(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, Progress());
}

std::vector<SkeletonWay> waysOf(const VoxelSet& set, std::size_t root, std::size_t least) {
  const std::vector<float> depths = depthsIn(set);
  std::vector<std::uint8_t> free(set.size(), 1);
  std::vector<SkeletonWay> ways;
  Skeleton skeleton(set, depths, free);
  skeleton.split(set.find(root), 4 * set.geometry().voxelSize(), least, Progress(), ways);
  return ways;
}

TEST(VoxelSet, FindsItsVoxelsAndTheirNeighbours) {
  const VolumeGeometry geometry = gridOf(5, 1);
  const VoxelSet set(geometry,
                     {at(geometry, 4, 0, 0), at(geometry, 0, 1, 0), at(geometry, 3, 1, 1)});
  EXPECT_EQ(set.find(at(geometry, 0, 1, 0)), 1U);
  EXPECT_EQ(set.find(at(geometry, 1, 1, 0)), VoxelSet::kNone);
  std::vector<std::uint32_t> beside;
  // the end of one row and the beginning of the next are no neighbours
  set.eachBeside(0, [&](std::uint32_t j, const Eigen::Vector3d&) { beside.push_back(j); });
  EXPECT_EQ(beside, std::vector<std::uint32_t>{2});
}

TEST(Skeleton, DepthInABallIsTheDistanceFromItsSurface) {
  const VolumeGeometry geometry = gridOf(21, 0.5);
  std::vector<std::size_t> ball;
  for (int z = 0; z < 21; ++z)
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 21; ++x)
        if ((x - 10) * (x - 10) + (y - 10) * (y - 10) + (z - 10) * (z - 10) <= 64)
          ball.push_back(at(geometry, x, y, z));
  const VoxelSet set(geometry, ball);
  const std::vector<float> depths = depthsIn(set);
  EXPECT_NEAR(depths[set.find(at(geometry, 10, 10, 10))], 4.0, 0.3);
  EXPECT_NEAR(depths[set.find(at(geometry, 14, 10, 10))], 2.0, 0.3);
}

/// Twenty voxels in a row, and ten more across it from its middle.
std::vector<std::size_t> fork(const VolumeGeometry& geometry) {
  std::vector<std::size_t> voxels;
  for (int x = 0; x < 20; ++x) voxels.push_back(at(geometry, x, 2, 2));
  for (int y = 3; y < 13; ++y) voxels.push_back(at(geometry, 9, y, 2));
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST(Skeleton, AForkHasTwoWays) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  const auto ways = waysOf(set, at(geometry, 0, 2, 2), 20);
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_NEAR(ways[0].length, 20 * 0.3, 0.3);
  EXPECT_EQ(set.index(ways[0].voxels.front()), at(geometry, 0, 2, 2));
  EXPECT_EQ(set.index(ways[0].voxels.back()), at(geometry, 19, 2, 2));
  // less what the first way covers: two voxels and three quarters
  EXPECT_NEAR(ways[1].length, 8 * 0.3, 0.35);
  EXPECT_EQ(set.index(ways[1].voxels.back()), at(geometry, 9, 12, 2));
  EXPECT_EQ(ways[0].covered + ways[1].covered, 30U);
}

TEST(Skeleton, ASpeckHasNone) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  EXPECT_TRUE(waysOf(set, at(geometry, 0, 2, 2), 31).empty());
}

}  // namespace
}  // namespace lumen::convert
