// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/seam.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/blobby.h"

namespace lumen::convert::fitting {
namespace {

using formats::Vec3d;

/// A blob in its node's centre whose surface has that radius.
Blob sphere(double radius) {
  const EnergyParameters p;
  return {0, 0, 0, formats::widthForRadius(p.kernel, p.kernelParameter, radius, p.isoLevel)};
}

TEST(Seam, OfTwoEqualSpheresIsTheirCircle) {
  const std::vector<Blob> model{sphere(1)};
  // centres 1.2 apart: the circle has the radius sqrt(1 - 0.6^2) = 0.8
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  for (const Vec3d& p : seam) {
    EXPECT_NEAR(p.x, 0.6, 1e-12);
    EXPECT_NEAR(std::hypot(p.y, p.z), 0.8, 1e-4);
  }
}

TEST(Seam, LiesHalfwayBetweenTheSurfaces) {
  // both nodes are as wide as each other, but the second one's model is not
  const std::vector<Blob> first{sphere(1)}, second{sphere(std::sqrt(0.36 + 0.49))};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, first}, {{{1.2, 0, 0}, 1}, second}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  for (const Vec3d& p : seam) EXPECT_NEAR(std::hypot(p.y, p.z), 0.75, 1e-4);
}

TEST(Seam, LiesOnTheRadicalPlane) {
  const std::vector<Blob> wide{sphere(1)}, narrow{sphere(0.8)};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, wide}, {{{1, 0, 0}, 0.8}, narrow}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  // x^2 - 1 = (x - 1)^2 - 0.64
  for (const Vec3d& p : seam) EXPECT_NEAR(p.x, 0.68, 1e-12);
}

TEST(Seam, LeavesOutWhatBelongsToAnotherNode) {
  const std::vector<Blob> model{sphere(1)};
  const std::vector<FitBall> others{{{0.6, 1, 0}, 1}};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, others);
  ASSERT_FALSE(seam.empty());
  EXPECT_LT(seam.size(), kSeamRays);
  // nearer than the other node where y <= 0.32: (y - 1)^2 >= 0.36 + y^2
  for (const Vec3d& p : seam) EXPECT_LE(p.y, 0.32);
}

TEST(Seam, LeavesOutSurfacesThatAreFarApart) {
  const std::vector<Blob> narrow{sphere(1)}, wide{sphere(1.7)};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, narrow}, {{{1.2, 0, 0}, 1}, wide}, {});
  EXPECT_TRUE(seam.empty());
}

TEST(Seam, OfModelsThatDoNotReachThePlaneIsEmpty) {
  const std::vector<Blob> model{sphere(0.5)};
  EXPECT_TRUE(seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, {}).empty());
}

TEST(Seam, OfNodesInOnePlaceIsEmpty) {
  const std::vector<Blob> model{sphere(1)};
  EXPECT_TRUE(seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{0, 0, 0}, 1}, model}, {}).empty());
}

}  // namespace
}  // namespace lumen::convert::fitting
