// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
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

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The first of the greatest falls, one sample at a time.
SteepestFall reference(const std::vector<float>& values, float sign) {
  std::size_t end = values.size(), best = 0;
  float strongest = 0;
  for (std::size_t i = 1; i + 1 < end; ++i) {
    const float fall = sign * (values[i - 1] - values[i + 1]);
    if (std::isnan(fall)) end = i;
    if (!(fall > strongest)) continue;
    strongest = fall;
    best = i;
  }
  if (best < 2 || best + 2 >= end) return {};
  const double before = static_cast<double>(sign * (values[best - 2] - values[best]));
  const double after = static_cast<double>(sign * (values[best] - values[best + 2]));
  const double bend = before - 2.0 * static_cast<double>(strongest) + after;
  const double shift = bend < 0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
  return {static_cast<double>(best) + shift, strongest};
}

TEST(SteepestFall, IsThatOfOneSampleAtATimeForAllLengthsAndEnds) {
  Random random(3);
  std::size_t found = 0;
  for (std::size_t size = 0; size <= 140; ++size)
    for (std::size_t beyond = 0; beyond <= std::min<std::size_t>(size, 12); ++beyond)
      for (const float sign : {1.0F, -1.0F}) {
        std::vector<float> values(size);
        // whole numbers make falls that are equal
        for (float& value : values) value = static_cast<float>(std::floor(random.uniform(0, 9)));
        // every other time the line comes back into what is known
        const std::size_t unknown = size % 2 == 0 ? beyond : (beyond + 1) / 2;
        std::fill_n(values.end() - static_cast<std::ptrdiff_t>(beyond), unknown, kNan);
        const SteepestFall expected = reference(values, sign), fall = steepestFall(values, sign);
        ASSERT_EQ(fall.sample, expected.sample) << size << ", " << beyond << " outside";
        ASSERT_EQ(fall.strength, expected.strength) << size << ", " << beyond << " outside";
        found += fall.strength > 0 ? 1U : 0U;
      }
  EXPECT_GT(found, 2000U);
}

TEST(SteepestFall, LiesBetweenSamplesByTheSlopesBeside) {
  std::vector<float> values;
  for (int i = 0; i < 40; ++i) values.push_back(static_cast<float>(std::tanh((17.3 - i) / 4)));
  EXPECT_NEAR(steepestFall(values, 1).sample, 17.3, 0.01);
  EXPECT_LT(steepestFall(values, -1).strength, 0);
}

TEST(SteepestFall, IsNoneOnALineThatBeginsOutsideOrIsEven) {
  std::vector<float> values(40, 1.0F);
  EXPECT_LT(steepestFall(values, 1).strength, 0);
  values[20] = 5;
  EXPECT_GT(steepestFall(values, 1).strength, 0);
  values[0] = kNan;
  EXPECT_LT(steepestFall(values, 1).strength, 0);
}

}  // namespace
}  // namespace lumen::convert
