// SPDX-License-Identifier: Apache-2.0
// Clicks in a vessel, beside it and far from it, in a volume whose vessel is 1000 over its background.
#include "converters/stages/finding/click_level.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kClickSize = 48;
constexpr double kAxis = 24;  // x and y of the vessel, which runs along z

/// Voxels of 1 mm with a vessel of radius 3 and noise of a deviation; what is below `cut` is 0.
Volume vesselIn(double noise, double contrast = 1000, double cut = -1e9) {
  Volume volume;
  volume.geometry.size = {kClickSize, kClickSize, kClickSize};
  Random random(1);
  std::vector<float> voxels;
  for (int z = 0; z < kClickSize; ++z)
    for (int y = 0; y < kClickSize; ++y)
      for (int x = 0; x < kClickSize; ++x) {
        const double inside = std::hypot(x - kAxis, y - kAxis) <= 3 ? contrast : 0;
        const double value = inside + noise * random.normal();
        voxels.push_back(static_cast<float>(value < cut ? 0 : value));
      }
  volume.voxels = std::move(voxels);
  return volume;
}

ClickLevel levelAt(const Volume& volume, const Vector3d& place, bool areVesselsDark = false) {
  const Progress progress;
  return ClickLevels(volume, areVesselsDark, progress).at(place);
}

TEST(ClickLevel, IsDarkBesideAVesselAndNotInIt) {
  const Volume volume = vesselIn(50);
  EXPECT_FALSE(levelAt(volume, {24, 24, 20}).isDark());
  EXPECT_NEAR(levelAt(volume, {24, 24, 20}).value, 1000, 40);
  EXPECT_NEAR(levelAt(volume, {24, 24, 20}).noise, 50, 5);
  for (const Vector3d& beside : {Vector3d(24, 30, 20), Vector3d(5, 5, 5), Vector3d(0, 0, 0)})
    EXPECT_TRUE(levelAt(volume, beside).isDark()) << levelAt(volume, beside).value;
}

TEST(ClickLevel, IsDarkWhereTheBackgroundWasCutOff) {
  const Volume volume = vesselIn(50, 1000, 500);
  EXPECT_TRUE(levelAt(volume, {24, 30, 20}).isDark());
  EXPECT_EQ(levelAt(volume, {24, 30, 20}).value, 0);
  // a person may click beside the rim by a voxel
  EXPECT_FALSE(levelAt(volume, {24, 28, 20}).isDark());
  EXPECT_TRUE(levelAt(volume, {24, 29, 20}).isDark());
}

TEST(ClickLevel, OfAVesselTwiceAsBrightAsTheNoiseIsNotDark) {
  const Volume volume = vesselIn(50, 100);
  for (int z = 4; z < 44; ++z) EXPECT_FALSE(levelAt(volume, {24, 24, double(z)}).isDark()) << z;
}

TEST(ClickLevel, InAVesselAsWideAsAllBlocksAroundIsNotDark) {
  constexpr int kWide = 160;
  Volume volume;
  volume.geometry.size = {kWide, kWide, 32};
  std::vector<float> voxels;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < kWide; ++y)
      for (int x = 0; x < kWide; ++x)
        voxels.push_back(std::hypot(x - 80, y - 80) <= 62 ? 900 : 100);
  volume.voxels = std::move(voxels);
  const ClickLevel level = levelAt(volume, {80, 80, 16});
  EXPECT_EQ(level.background, 900);
  EXPECT_EQ(level.quiet, 100);
  EXPECT_FALSE(level.isDark());
  EXPECT_TRUE(levelAt(volume, {4, 4, 16}).isDark());
}

TEST(ClickLevel, InADarkVesselIsNotTheBackgrounds) {
  const Volume volume = vesselIn(50, -1000);
  EXPECT_FALSE(levelAt(volume, {24, 24, 20}, true).isDark());
  EXPECT_TRUE(levelAt(volume, {24, 30, 20}, true).isDark());
}

TEST(ClickLevel, OutsideOfTheVoxelsIsThatOfTheNearest) {
  const Volume volume = vesselIn(0);
  EXPECT_NEAR(levelAt(volume, {24, 24, -0.4}).value, 1000, 1e-3);
}

}  // namespace
}  // namespace lumen::convert
