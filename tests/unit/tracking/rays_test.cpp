// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/rays.h"

#include <gtest/gtest.h>

#include "converters/geometry/icosphere.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

const Eigen::Vector3d kMiddle(6.3, 6.1, 6.2);

Volume ball(double radius) {
  return drawVolume(64, 0.2,
                    [&](const Eigen::Vector3d& p) { return (p - kMiddle).norm() - radius; });
}

TEST(Rays, MeetTheWallOfABallInEveryDirection) {
  const Volume volume = ball(2.0);
  const BsplineVolume spline(volume);
  RayCaster rays(spline, icosphere(3), 128, false);
  Candidates points;
  rays.cast(kMiddle, 6.0, points);
  ASSERT_EQ(points.count(), 162u);
  for (std::size_t i = 0; i < points.count(); ++i)
    EXPECT_NEAR(points.offset(i).norm(), 2.0, 0.05);  // a quarter of a voxel
}

TEST(Rays, SeeADarkBallOnlyWhenToldSo) {
  Volume volume = ball(2.0);
  for (auto& v : std::get<std::vector<std::int16_t>>(volume.voxels))
    v = static_cast<std::int16_t>(1000 - v);
  const BsplineVolume spline(volume);
  Candidates points;
  RayCaster(spline, icosphere(2), 128, true).cast(kMiddle, 6.0, points);
  EXPECT_EQ(points.count(), 42u);
  RayCaster(spline, icosphere(2), 128, false).cast(kMiddle, 6.0, points);
  for (std::size_t i = 0; i < points.count(); ++i)
    EXPECT_GT(std::abs(points.offset(i).norm() - 2.0), 0.05);
}

TEST(Rays, DropWallsNearerThanATwelfthOrFartherThanFourFifthsOfTheirLength) {
  const Volume volume = ball(2.0);
  const BsplineVolume spline(volume);
  RayCaster rays(spline, icosphere(2), 128, false);
  Candidates points;
  rays.cast(kMiddle, 2.4, points);  // 0.8 * 2.4 = 1.92 < 2
  EXPECT_EQ(points.count(), 0u);
  rays.cast(kMiddle, 26.0, points);  // 26 / 12 = 2.17 > 2
  EXPECT_EQ(points.count(), 0u);
}

TEST(Rays, FindNothingInAConstantNeighbourhood) {
  const Volume volume = ball(0.5);
  const BsplineVolume spline(volume);
  RayCaster rays(spline, icosphere(2), 128, false);
  Candidates points;
  rays.cast(Eigen::Vector3d(2, 2, 2), 1.0, points);
  for (std::size_t i = 0; i < points.count(); ++i) EXPECT_LT(points.strength[i], 1.0F);
}

}  // namespace
}  // namespace lumen::convert
