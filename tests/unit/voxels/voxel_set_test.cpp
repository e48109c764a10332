// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/voxel_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/volume.h"

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

using Eigen::Vector3d;

TEST(Depth, DistancesAreThoseOfTryingEveryPair) {
  const CellBox box{{3, -1, 7}, {7, 6, 5}};
  const Vector3d spacing(0.5, 1, 1.5);
  Random random(1, 2);
  std::vector<std::uint8_t> mark(box.count());
  for (std::uint8_t& m : mark) m = random.uniform() < 0.05 ? 1 : 0;
  const std::vector<float> found = distancesTo(box, spacing, mark, 1, Progress());
  for (std::size_t i = 0; i < mark.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < mark.size(); ++j)
      if (mark[j] == 1)
        least = std::min(least,
                         spacing.cwiseProduct((box.cell(i) - box.cell(j)).cast<double>()).norm());
    EXPECT_FLOAT_EQ(found[i], static_cast<float>(least)) << i;
  }
}

TEST(Depth, WithoutATargetDistancesAreInfinite) {
  const CellBox box{Cell::Zero(), {3, 3, 3}};
  const std::vector<std::uint8_t> mark(27, 0);
  for (const float d : distancesTo(box, Vector3d::Ones(), mark, 1, Progress()))
    EXPECT_TRUE(std::isinf(d));
}

TEST(Depth, InABallItIsTheDistanceFromItsSurface) {
  VolumeGeometry geometry;
  geometry.size = {21, 21, 21};
  geometry.spacing.setConstant(0.5);
  std::vector<std::size_t> ball;
  geometry.cells().forEach([&](const Cell& cell) {
    if ((cell - Cell(10, 10, 10)).squaredNorm() <= 64) ball.push_back(geometry.index(cell));
  });
  const VoxelSet set(geometry, ball);
  const std::vector<float> depths = measureDepths(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, Progress());
  EXPECT_NEAR(depths[set.find(geometry.index({10, 10, 10}))], 4.0, 0.3);
  EXPECT_NEAR(depths[set.find(geometry.index({14, 10, 10}))], 2.0, 0.3);
  EXPECT_NEAR(depths[set.find(geometry.index({10, 10, 6}))], 2.0, 0.3);
}

TEST(Depth, OfAMeasureIsWhatItGives) {
  VolumeGeometry geometry;
  geometry.size = {4, 4, 4};
  const VoxelSet set(geometry, {0, 5, 63});
  const auto depths = depthsBy(
      set, [](const Vector3d& p) { return p.sum(); }, Progress());
  EXPECT_EQ(depths, (std::vector<float>{0, 2, 9}));
}

using Eigen::Vector3d;

TEST(CellBox, NumbersItsCellsAlongTheFirstAxisFirst) {
  const CellBox box{{1, -2, 3}, {4, 3, 2}};
  EXPECT_EQ(box.count(), 24U);
  EXPECT_EQ(box.index({1, -2, 3}), 0U);
  EXPECT_EQ(box.index({2, -2, 3}), 1U);
  EXPECT_EQ(box.index({1, -1, 3}), box.stride(1));
  EXPECT_EQ(box.index({1, -2, 4}), box.stride(2));
  std::size_t next = 0;
  box.forEach([&](const Cell& cell) {
    EXPECT_EQ(box.index(cell), next);
    EXPECT_EQ(box.cell(next), cell);
    ++next;
  });
  EXPECT_EQ(next, 24U);
}

TEST(CellBox, HoldsItsCornersAndNothingBeyondOnAnyAxis) {
  const CellBox box = CellBox::between({1, 2, 3}, {4, 6, 8});
  EXPECT_EQ(box.high(), Cell(4, 6, 8));
  EXPECT_TRUE(box.contains({1, 2, 3}));
  EXPECT_TRUE(box.contains({4, 6, 8}));
  for (int a = 0; a < 3; ++a) {
    EXPECT_FALSE(box.contains(box.low - Cell::Unit(a))) << a;
    EXPECT_FALSE(box.contains(box.high() + Cell::Unit(a))) << a;
  }
}

TEST(CellBox, NearestRoundsAndEndsHalfACellBeyond) {
  const CellBox box = CellBox::between({0, 0, 0}, {3, 3, 3});
  EXPECT_EQ(box.nearest({1.4, 1.6, 2.5}), Cell(1, 2, 3));
  EXPECT_TRUE(box.nearest({-0.4, 0, 3.4}));
  EXPECT_FALSE(box.nearest({-0.6, 0, 0}));
  EXPECT_FALSE(box.nearest({0, 3.6, 0}));
  EXPECT_FALSE(box.nearest({0, 0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(box.nearest({0, 0, 1e300}));
}

TEST(CellBox, NeighboursShareACornerAndLieInTheBox) {
  const CellBox box{Cell::Zero(), {3, 3, 3}};
  const auto neighbours = [&](const Cell& cell) {
    std::size_t count = 0;
    box.forEachNeighbour(cell, [&](const Cell& other) {
      EXPECT_LE((other - cell).cwiseAbs().maxCoeff(), 1);
      ++count;
    });
    return count;
  };
  EXPECT_EQ(neighbours({1, 1, 1}), 26U);
  EXPECT_EQ(neighbours({0, 1, 1}), 17U);
  EXPECT_EQ(neighbours({0, 0, 2}), 7U);
}

TEST(CellBox, BoxesThatAreApartMeetInNoCell) {
  const CellBox a{Cell::Zero(), {2, 2, 2}}, b{{1, 1, 1}, {5, 5, 5}}, c{{4, 0, 0}, {2, 2, 2}};
  EXPECT_EQ(a.meet(b).count(), 1U);
  EXPECT_EQ(a.meet(c).count(), 0U);
}

TEST(VolumeGeometry, CellsAndPositionsAgree) {
  VolumeGeometry geometry;
  geometry.size = {5, 6, 7};
  geometry.spacing = {0.5, 1, 2};
  geometry.origin = {10, 20, 30};
  EXPECT_EQ(geometry.index({4, 5, 6}), geometry.voxelCount() - 1);
  EXPECT_EQ(geometry.cell(geometry.index({3, 2, 1})), Cell(3, 2, 1));
  EXPECT_EQ(geometry.position({2, 3, 1}), Vector3d(11, 23, 32));
  EXPECT_FALSE(geometry.contains({5, 0, 0}));
  const CellBox around = geometry.cellsAround({0.5, -3, 5.5}, {2.5, 1, 99});
  EXPECT_EQ(around.low, Cell(0, 0, 5));
  EXPECT_EQ(around.high(), Cell(3, 1, 6));
}

}  // namespace
}  // namespace lumen::convert
