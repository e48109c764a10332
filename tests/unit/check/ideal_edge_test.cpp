// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/judge/check/wall_samples.h"

namespace lumen::convert {
namespace {

TEST(IdealEdge, IsNotDisplacedWithoutBlur) {
  const IdealEdge edge(0, 0.2);
  EXPECT_EQ(edge.ofCylinder(1), 0);
  EXPECT_EQ(edge.ofBall(1), 0);
}

// Level sets of a blurred shape move by half the variance times the sum of the curvatures.
TEST(IdealEdge, OfAWideVesselLiesInsideByTheVarianceOverItsDiameter) {
  const double s = 0.14, voxel = 0.2;
  const IdealEdge edge(s, voxel);
  for (const double radius : {2.0, 2.35, 2.45, 4.0}) {
    EXPECT_NEAR(edge.ofCylinder(radius), -s * s / (2 * radius), 0.005 * voxel);
    EXPECT_NEAR(edge.ofBall(radius), -s * s / radius, 0.01 * voxel);
  }
}

TEST(IdealEdge, ScalesWithTheUnit) {
  const IdealEdge small(0.06, 0.1), large(0.6, 1);
  for (const double radius : {0.8, 1.5, 3.0, 20.0})
    EXPECT_NEAR(10 * small.ofCylinder(0.1 * radius), large.ofCylinder(radius), 1e-5);
}

// The peak of a thin vessel falls, and with it the half level, which makes it look wider.
TEST(IdealEdge, OfAVesselAsThinAsTheBlurLiesOutside) {
  EXPECT_GT(IdealEdge(0.67, 1).ofCylinder(0.75), 0.05);
}

}  // namespace
}  // namespace lumen::convert
