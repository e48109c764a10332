// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/vessel_at_click.h"

#include <gtest/gtest.h>

#include "converters/stages/phantom/phantom.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

TrackingVolume readied(const Volume& volume) {
  Progress silent;
  TrackOptions options;
  options.pointSpread = 0;
  return {volume, {seedAt("tube", {6.4, 6.4, 6.4})}, options, silent};
}

class VesselAtClickOfRadius : public testing::TestWithParam<double> {};

TEST_P(VesselAtClickOfRadius, FindsTheAxisFromAnywhereInTheLumen) {
  const double radius = GetParam();
  const Volume volume = straightTube(radius);
  const TrackingVolume tracking = readied(volume);
  for (const Vector3d& aside : {Vector3d(0, 0, 0), Vector3d(0.5, 0, 0.1), Vector3d(-0.4, 0.6, 0)}) {
    const VesselAtClick vessel = vesselAtClick(tracking, Vector3d(6.4, 6.4, 6.4) + radius * aside);
    ASSERT_TRUE(vessel.found) << vessel.reason;
    EXPECT_LT(std::hypot(vessel.position.x() - 6.4, vessel.position.y() - 6.4), 0.1);
    EXPECT_NEAR(vessel.position.z(), 6.4 + radius * aside.z(), 0.1);
    EXPECT_NEAR(vessel.radius, radius, 0.1);
    EXPECT_GT(std::abs(vessel.direction.z()), 0.97);
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, VesselAtClickOfRadius, testing::Values(0.5, 0.8, 1.2, 2.0));

TEST(VesselAtClick, FindsAVesselThatIsClickedAVoxelBesideItsRim) {
  const Volume volume = straightTube(0.6);
  const VesselAtClick vessel = vesselAtClick(readied(volume), {7.2, 6.4, 6.4});
  ASSERT_TRUE(vessel.found) << vessel.reason;
  EXPECT_LT(std::hypot(vessel.position.x() - 6.4, vessel.position.y() - 6.4), 0.1);
}

TEST(VesselAtClick, SaysWhenThereIsNoVessel) {
  const Volume volume = straightTube(0.6);
  const Vector3d click(2, 2, 6.4);
  const VesselAtClick vessel = vesselAtClick(readied(volume), click);
  EXPECT_FALSE(vessel.found);
  EXPECT_EQ(vessel.position, click);
  EXPECT_FALSE(vessel.reason.empty());
}

TEST(VesselAtClick, SaysWhenTheClickIsOutsideOfTheVolume) {
  const Volume volume = straightTube(0.6);
  const VesselAtClick vessel = vesselAtClick(readied(volume), {-50, 6.4, 6.4});
  EXPECT_FALSE(vessel.found);
  EXPECT_NE(vessel.reason.find("outside"), std::string::npos) << vessel.reason;
}

TEST(VesselAtClick, IsTheSameEveryTime) {
  const Volume volume = noisy(straightTube(0.8), 60);
  const TrackingVolume tracking = readied(volume);
  const VesselAtClick once = vesselAtClick(tracking, {6.6, 6.3, 5});
  for (int i = 0; i < 3; ++i) {
    const VesselAtClick again = vesselAtClick(tracking, {6.6, 6.3, 5});
    EXPECT_EQ(again.position, once.position);
    EXPECT_EQ(again.radius, once.radius);
  }
}

TEST(ClickLight, CountsTheClicksInVesselsAndNoneBesideThem) {
  PhantomOptions options;
  options.name = "bifurcation";
  options.size = 64;
  Progress progress;
  const Phantom phantom = makePhantom(options, progress);
  const TrackOptions track;
  const ClickLight light(phantom.volume, track, progress);
  EXPECT_EQ(light.countInVessels(phantom.seeds), phantom.seeds.size());
  std::vector<SeedBranch> mirrored = phantom.seeds;
  for (SeedBranch& seed : mirrored)  // out of the middle, where the vessels are
    seed.points[0].position = {0.5, 0.5, seed.points[0].position.z()};
  EXPECT_EQ(light.countInVessels(mirrored), 0U);
}

}  // namespace
}  // namespace lumen::convert
