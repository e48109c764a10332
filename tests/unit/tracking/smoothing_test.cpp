// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/smoothing.h"

#include <gtest/gtest.h>

#include "converters/base/options/edit_steps.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

TEST(NoiseFloor, IsZeroWithoutNoiseAndGrowsInProportionToIt) {
  const Volume clean = straightTube(0.6);
  EXPECT_EQ(noiseFloor(BsplineVolume(clean), TrackOptions{}, Progress{}), 0.0);
  const Volume weak = noisy(clean, 20), strong = noisy(clean, 80);
  const double ratio = noiseFloor(BsplineVolume(strong), TrackOptions{}, Progress{}) /
                       noiseFloor(BsplineVolume(weak), TrackOptions{}, Progress{});
  EXPECT_NEAR(ratio, 4.0, 0.3);
}

TEST(Smoothing, IsNoneWithoutNoiseAndGrowsWithIt) {
  const Volume clean = straightTube(0.6);
  const std::vector<SeedBranch> seeds{seedAt("tube", {6.4, 6.4, 6.0})};
  EXPECT_NEAR(contrastAtClicks(BsplineVolume(clean), seeds, TrackOptions{}, Progress{}), 1000, 20);
  EXPECT_EQ(smoothForNoise(clean, clean.geometry, seeds, TrackOptions{}, Progress{}).smoothing,
            0.0);
  double last = 0;
  for (const double noise : {80.0, 200.0, 400.0}) {
    const double smoothing =
        smoothForNoise(noisy(clean, noise), clean.geometry, seeds, TrackOptions{}, Progress{})
            .smoothing;
    EXPECT_GT(smoothing, last);
    last = smoothing;
  }
  EXPECT_LE(last, 1.25 * 0.2);
}

// Half of an edge along each axis: 0.25 * 1.5^2 = 0.25 * (1.5 * 0.5)^2 + s^2.
TEST(SmoothingAlongAxes, EvensTheBlurOfThickSlicesOnly) {
  VolumeGeometry geometry;
  geometry.spacing = {0.5, 0.5, 1.5};
  const Eigen::Vector3d thick = smoothingAlongAxes(geometry, 0, true);
  EXPECT_NEAR(thick[0], 0.6495, 1e-4);
  EXPECT_EQ(thick[0], thick[1]);
  EXPECT_EQ(thick[2], 0);
  EXPECT_EQ(smoothingAlongAxes(geometry, 0, false), Eigen::Vector3d::Zero());
  EXPECT_EQ(smoothingAlongAxes(geometry, 0.4, false), Eigen::Vector3d::Constant(0.4));
  EXPECT_NEAR(smoothingAlongAxes(geometry, 0.4, true)[0], std::hypot(0.6495, 0.4), 1e-4);
  geometry.spacing = {0.7, 0.7, 1.0};
  EXPECT_EQ(smoothingAlongAxes(geometry, 0, true), Eigen::Vector3d::Zero());
}

TEST(Smoothing, FindsAThinVesselInStrongNoise) {
  const Volume volume = noisy(straightTube(0.4), 250);  // a quarter of the contrast
  TrackOptions rough;
  rough.smoothing = 0.0;
  Progress silent;
  const std::vector<SeedBranch> seeds{seedAt("tube", {6.4, 6.4, 6.0})};
  EXPECT_TRUE(trackFromSeeds(volume, seeds, rough, silent).result.tree.branches.empty());
  const auto tracked = trackFromSeeds(volume, seeds, TrackOptions{}, silent).result;
  ASSERT_EQ(tracked.tree.branches.size(), 1u);
  EXPECT_LT(tracked.tree.centre.front().z, 1.5F);
  EXPECT_GT(tracked.tree.centre.back().z, 11.0F);
  EXPECT_GT(std::get<double>(tracked.metadata.steps[0].parameters.at("smoothing")), 0.1);
}

TEST(TrackedCase, RecordsWhatTheReaderOfItsVolumeTookForGranted) {
  Volume volume = straightTube(1.0);
  volume.assumptions = {"left may be right"};
  Progress silent;
  const auto tracked =
      trackFromSeeds(volume, {seedAt("tube", {6.4, 6.4, 6.0})}, TrackOptions{}, silent).result;
  EXPECT_EQ(recordedAssumptions(tracked.metadata), volume.assumptions);
}

TEST(NoiseFloor, NeedsABoundedPartOfTheSplineHoweverUnevenVoxelsAre) {
  Volume volume;
  volume.geometry.size = {700, 700, 40};
  volume.voxels = std::vector<std::uint8_t>(volume.geometry.voxelCount(), 1);
  for (const double edge : {1.0, 30.0, 300.0, 1000.0}) {
    volume.geometry.spacing = {1, 1, edge};
    const BsplineVolume spline(volume);
    (void)noiseFloor(spline, TrackOptions{}, Progress{});
    // ten bricks for each of 64 places; a brick has 36 x 35 x 35 floats
    EXPECT_LT(spline.coefficientBytes(), 640u * 36 * 35 * 35 * 4) << edge;
  }
}

TEST(NoiseFloor, CanBeCancelled) {
  const Volume volume = straightTube(0.6);
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW((void)noiseFloor(BsplineVolume(volume), TrackOptions{}, cancelled), Error);
  EXPECT_THROW((void)contrastAtClicks(BsplineVolume(volume), {seedAt("a", {6, 6, 6})},
                                      TrackOptions{}, cancelled),
               Error);
}

}  // namespace
}  // namespace lumen::convert
