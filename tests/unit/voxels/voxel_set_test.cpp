// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/voxel_set.h"

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

TEST(VoxelSet, FindsItsVoxelsAndTheirNeighbours) {
  VolumeGeometry geometry;
  geometry.size = {5, 5, 5};
  const VoxelSet set(
      geometry, {geometry.index({4, 0, 0}), geometry.index({0, 1, 0}), geometry.index({3, 1, 1})});
  EXPECT_EQ(set.find(geometry.index({0, 1, 0})), 1U);
  EXPECT_EQ(set.find(geometry.index({1, 1, 0})), VoxelSet::kNone);
  EXPECT_EQ(set.cell(2), Cell(3, 1, 1));
  std::vector<std::uint32_t> beside;
  // the end of one row and the beginning of the next are no neighbours
  set.eachBeside(0, [&](std::uint32_t j, const Eigen::Vector3d&) { beside.push_back(j); });
  EXPECT_EQ(beside, std::vector<std::uint32_t>{2});
}

TEST(VoxelSet, WithinADistanceThatLeavesTheVolumeLiesAll) {
  VolumeGeometry geometry;
  geometry.size = {3, 4, 5};
  geometry.spacing = {1, 2, 3};
  std::vector<std::size_t> all(geometry.voxelCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const VoxelSet set(geometry, all);
  for (const double reach : {100.0, 1e300}) {
    std::size_t count = 0;
    set.eachWithin(7, reach, [&](std::uint32_t) { ++count; });
    EXPECT_EQ(count, all.size()) << reach;
  }
  std::size_t near = 0;
  set.eachWithin(set.find(geometry.index({1, 1, 1})), 2, [&](std::uint32_t) { ++near; });
  EXPECT_EQ(near, 5U);  // itself, two along x, two along y
}

}  // namespace
}  // namespace lumen::convert
