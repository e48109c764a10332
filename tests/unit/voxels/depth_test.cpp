// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen::convert {
namespace {

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

}  // namespace
}  // namespace lumen::convert
