// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/ridges.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The strength at the voxel of a place in mm.
float at(const Volume& volume, const std::vector<float>& strength, const Vector3d& place) {
  const Vector3d index = volume.geometry.indexFromWorld(place);
  return strength[volume.geometry.index(Cell(index.array().round().matrix().cast<int>()))];
}

TEST(Ridges, AThinTubeIsOneAndItsSurroundingsAreNot) {
  // across two bricks and oblique to all axes
  const Volume volume = drawVolume(80, 1, [](const Vector3d& p) {
    return capsule(p, {10, 12, 8}, {70, 66, 74}, 1.5);
  });
  const auto strength = ridgeStrength(volume, 1, Progress());
  for (const double t : {0.2, 0.5, 0.8}) {
    const Vector3d on = Vector3d(10, 12, 8) + t * Vector3d(60, 54, 66);
    EXPECT_GT(at(volume, strength, on), 120) << t;
    EXPECT_LT(at(volume, strength, on + Vector3d(8, -8, 0)), 5) << t;
  }
}

TEST(Ridges, ADarkTubeIsOneWithTheOtherSign) {
  const Volume volume = drawVolume(40, 1, [](const Vector3d& p) {
    return -capsule(p, {20, 20, 4}, {20, 20, 36}, 1.5);
  });
  EXPECT_GT(at(volume, ridgeStrength(volume, -1, Progress()), {20, 20, 20}), 120);
  EXPECT_EQ(at(volume, ridgeStrength(volume, 1, Progress()), {20, 20, 20}), 0);
}

TEST(Ridges, NeitherASheetNorABallNorTheWallOfAWideTubeIsOne) {
  const auto strengthOf = [](const std::function<double(const Vector3d&)>& distance,
                             const Vector3d& place) {
    const Volume volume = drawVolume(48, 1, distance);
    return at(volume, ridgeStrength(volume, 1, Progress()), place);
  };
  EXPECT_EQ(strengthOf([](const Vector3d& p) { return std::abs(p.x() - 24) - 1.5; }, {24, 24, 24}),
            0);
  EXPECT_EQ(strengthOf([](const Vector3d& p) { return (p - Vector3d(24, 24, 24)).norm() - 2; },
                       {24, 24, 24}),
            0);
  EXPECT_LT(strengthOf(
                [](const Vector3d& p) {
                  return capsule(p, {24, 24, 4}, {24, 24, 44}, 9);
                },
                {34, 24, 24}),
            20);
}

TEST(Ridges, AreTheSameInMillimetresForVoxelsOfAnySize) {
  Volume volume = drawVolume(40, 1, [](const Vector3d& p) {
    return capsule(p, {20, 20, 4}, {20, 20, 36}, 1.5);
  });
  const float before = at(volume, ridgeStrength(volume, 1, Progress()), {20, 20, 20});
  volume.geometry.spacing.setConstant(0.3);
  const float after = at(volume, ridgeStrength(volume, 1, Progress()), {6, 6, 6});
  EXPECT_NEAR(after, before, 1e-3 * before);
}

}  // namespace
}  // namespace lumen::convert
