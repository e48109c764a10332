// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/cell_box.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "converters/voxels/volume.h"

namespace lumen::convert {
namespace {

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
