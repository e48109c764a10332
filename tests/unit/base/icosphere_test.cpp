// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/icosphere.h"

#include <numbers>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

TEST(Icosphere, HasTheVertexCountOfItsOrder) {
  EXPECT_EQ(icosphere(1).size(), 12u);
  EXPECT_EQ(icosphere(2).size(), 42u);
  EXPECT_EQ(icosphere(3).size(), 162u);
  EXPECT_EQ(icosphere(4).size(), 642u);
}

TEST(Icosphere, OrderIsFoundFromTheVertexCount) {
  EXPECT_EQ(icosphereOrder(162), 3);
  EXPECT_EQ(icosphereOrder(642), 4);
  EXPECT_EQ(icosphereOrder(100), 0);
}

TEST(Icosphere, VerticesAreUnitAndComeInOppositePairs) {
  const auto sphere = icosphere(3);
  for (std::size_t i = 0; i < sphere.size(); i += 2) {
    EXPECT_NEAR(sphere[i].norm(), 1.0, 1e-12);
    EXPECT_NEAR((sphere[i] + sphere[i + 1]).norm(), 0.0, 1e-12);
  }
}

TEST(Icosphere, NearestVerticesOfOrderThreeAreSeparatedByAboutSixteenToTwentyDegrees) {
  const auto sphere = icosphere(3);
  for (const auto& a : sphere) {
    double closest = 180;
    for (const auto& b : sphere)
      if ((a - b).norm() > 1e-9)
        closest = std::min(closest, std::acos(a.dot(b)) * 180 / std::numbers::pi);
    EXPECT_GT(closest, 15.0);
    EXPECT_LT(closest, 20.0);
  }
}

TEST(Axes, StartAtTheDirectionAndGoAwayFromIt) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, -2, 0.5).normalized();
  const auto axes = axesAround(direction, icosphere(3));
  ASSERT_EQ(axes.size(), 81u);
  EXPECT_NEAR((axes[0] - direction).norm(), 0.0, 1e-12);
  for (std::size_t i = 1; i < axes.size(); ++i) {
    EXPECT_LE(axes[i].dot(direction), axes[i - 1].dot(direction));
    EXPECT_GE(axes[i].dot(direction), -1e-12);
  }
}

}  // namespace
}  // namespace lumen::convert
