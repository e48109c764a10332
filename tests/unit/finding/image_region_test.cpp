// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/image_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/finding/background.h"
#include "converters/stages/finding/find_vessels.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Inside = std::function<bool(const Vector3d&)>;
using ContinuedVolume = std::shared_ptr<const Volume>;

constexpr int kSize = 64;
constexpr double kTissue = 300, kNoise = 20;
const Vector3d kMiddle(31.5, 31.5, 31.5);

/// Shapes of an image: one that stands, one that is turned, one without a flat side.
const std::vector<Inside> kShapes = {
    [](const Vector3d& p) { return (p - kMiddle).head<2>().norm() < 28; },
    [](const Vector3d& p) {
      const Vector3d q = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()) * (p - kMiddle);
      return q.cwiseAbs().maxCoeff() < 20;
    },
    [](const Vector3d& p) {
      return (p - kMiddle - Vector3d(4, 0, 0)).norm() < 24 ||
             (p - kMiddle + Vector3d(8, 3, 2)).norm() < 20;
    }};
const std::vector<std::int16_t> kFills = {0, -1024, -2048, 150, 1000};

std::vector<std::int16_t>& voxelsOf(Volume& volume) {
  return std::get<std::vector<std::int16_t>>(volume.voxels);
}

/// A vessel of radius 3 from face to face, in noisy tissue.
Volume vesselInTissue() {
  Volume volume = drawVolume(kSize, 1, [](const Vector3d& p) {
    return capsule(p, {-9, 20, 24}, {72, 42, 38}, 3);
  });
  for (std::int16_t& voxel : voxelsOf(volume))
    voxel = static_cast<std::int16_t>(kTissue + voxel / 2);
  return noisy(std::move(volume), kNoise);
}

void fillOutside(Volume& volume, const Inside& isInside, std::int16_t fill) {
  for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i)
    if (!isInside(volume.geometry.position(volume.geometry.cell(i)))) voxelsOf(volume)[i] = fill;
}

Volume cut(const Inside& isInside, std::int16_t fill) {
  Volume volume = vesselInTissue();
  fillOutside(volume, isInside, fill);
  return volume;
}

/// The share of the places half a voxel from a place along all axes that lie inside.
double shareInside(const Inside& isInside, const Vector3d& place) {
  double share = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d aside(corner % 2 - 0.5, corner / 2 % 2 - 0.5, corner / 4 - 0.5);
    share += isInside(place + aside) ? 0.125 : 0;
  }
  return share;
}

/// The same with a border that linear interpolation halfway between voxels has blurred.
Volume blurred(const Inside& isInside, std::int16_t fill) {
  Volume volume = vesselInTissue();
  for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i) {
    const double share = shareInside(isInside, volume.geometry.position(volume.geometry.cell(i)));
    voxelsOf(volume)[i] =
        static_cast<std::int16_t>(std::lround(fill + share * (voxelsOf(volume)[i] - fill)));
  }
  return volume;
}

ContinuedVolume continued(const Volume& volume) {
  return continueImage(volume, Progress());
}

bool hasBorder(const Volume& volume) {
  return continued(volume) != nullptr;
}

/// The number of voxels that are image on one side alone.
std::size_t countWrong(const Volume& volume, const Inside& isInside) {
  const ContinuedVolume out = continued(volume);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < volume.geometry.voxelCount(); ++i)
    if ((!out || out->geometry.isImage(i)) !=
        isInside(volume.geometry.position(volume.geometry.cell(i))))
      ++wrong;
  return wrong;
}

TEST(ImageRegion, IsWhatNoFillCoversWhateverItsShapeAndValue) {
  for (const Inside& isInside : kShapes)
    for (const std::int16_t fill : kFills) EXPECT_EQ(countWrong(cut(isInside, fill), isInside), 0U);
}

TEST(ImageRegion, AFillOfTheMeanIsKnownButForSingleEqualVoxelsBesideIt) {
  const Volume volume = cut(kShapes[0], static_cast<std::int16_t>(kTissue));
  ASSERT_TRUE(hasBorder(volume));
  EXPECT_LT(countWrong(volume, kShapes[0]), volume.geometry.voxelCount() / 500);
}

TEST(ImageRegion, HoldsNoVoxelThatTheFillBlurs) {
  for (std::size_t s = 0; s < kShapes.size(); ++s) {
    const Inside& isInside = kShapes[s];
    const ContinuedVolume out = continued(blurred(isInside, -1024));
    ASSERT_TRUE(out);
    std::size_t whole = 0, kept = 0, wrong = 0;
    for (std::size_t i = 0; i < out->geometry.voxelCount(); ++i) {
      const double share = shareInside(isInside, out->geometry.position(out->geometry.cell(i)));
      whole += share == 1 ? 1 : 0;
      kept += share == 1 && out->geometry.isImage(i) ? 1 : 0;
      wrong += share < 1 && out->geometry.isImage(i) ? 1 : 0;
    }
    // the notch between the balls of the last shape ends in voxels that are blurred alone
    EXPECT_LE(wrong, s < 2 ? 0 : whole / 100) << s;
    EXPECT_GT(kept, whole * 9 / 10);
  }
}

TEST(ImageRegion, TheBackgroundOfVesselsIsNoFill) {
  const auto vessels = [](const Vector3d& p) {
    return std::min(capsule(p, {24, 30, -9}, {24, 30, 72}, 7),
                    capsule(p, {24, 30, 30}, {50, 30, 44}, 2));
  };
  Volume volume = drawVolume(kSize, 1, vessels);
  EXPECT_FALSE(hasBorder(volume));  // without noise
  Volume inLumen = noisy(volume, kNoise);
  for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i)
    if (voxelsOf(volume)[i] == 0) voxelsOf(inLumen)[i] = 0;
  EXPECT_FALSE(hasBorder(inLumen));  // with noise in the lumen alone
  for (std::int16_t& voxel : voxelsOf(inLumen))
    if (voxel < 600) voxel = 0;
  EXPECT_FALSE(hasBorder(inLumen));  // with all below a threshold set to 0
  Volume clipped = noisy(volume, kNoise);
  for (std::int16_t& voxel : voxelsOf(clipped)) voxel = std::max<std::int16_t>(voxel, 0);
  EXPECT_FALSE(hasBorder(clipped));  // noise below 0 is 0
  for (std::int16_t& voxel : voxelsOf(volume)) voxel = voxel > 500 ? 1 : 0;
  EXPECT_FALSE(hasBorder(volume));  // a mask
  const auto block = [](const Vector3d& p) {
    return ((p - kMiddle).cwiseAbs() - Vector3d(24, 20, 20)).maxCoeff();
  };
  EXPECT_FALSE(hasBorder(drawVolume(kSize, 1, block)));  // thick, without noise
  EXPECT_TRUE(hasBorder(cut([&](const Vector3d& p) { return block(p) < 0; }, 0)));
}

Volume cutToTube(double radius) {
  return cut([=](const Vector3d& p) { return (p - kMiddle).head<2>().norm() < radius; }, 0);
}

TEST(ImageRegion, IsATenthOfTheVolumeAtLeast) {
  EXPECT_FALSE(hasBorder(cutToTube(11.2)));  // 9.6 % of it, 4.4 voxels for each face
  EXPECT_TRUE(hasBorder(cutToTube(11.8)));   // 10.7 %
}

TEST(ImageRegion, IsThick) {
  const auto plates = [](int thick) {  // they fill 7/11 and 9/11 of the volume
    return cut([=](const Vector3d& p) { return std::fmod(p.z(), thick + 4) > 3.5; }, 0);
  };
  EXPECT_FALSE(hasBorder(plates(7)));  // two faces each: 3.5 voxels for each face
  EXPECT_TRUE(hasBorder(plates(9)));   // 4.5
}

TEST(ImageRegion, AFillHasAVoxelForEachFaceOnItsBorder) {
  const auto spikes = [](int every) {  // single rows through the tissue, on four layers
    Volume volume = vesselInTissue();
    for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i) {
      const Cell cell = volume.geometry.cell(i);
      const bool isSpike = cell[0] % every == 0 && cell[1] % every == 0;
      if (cell[2] < (isSpike ? 34 : 4)) voxelsOf(volume)[i] = 0;
    }
    return volume;
  };
  EXPECT_TRUE(hasBorder(spikes(7)));   // 4 + 30 / 49 voxels for 1 + 120 / 49 faces: 1.3
  EXPECT_FALSE(hasBorder(spikes(5)));  // 21454 voxels, 23596 faces
}

TEST(ImageRegion, PaddingThatTheFileStatesNeedsNoEvidence) {
  Volume volume = cutToTube(6);
  EXPECT_FALSE(hasBorder(volume));
  volume.padding = {-3, 0};
  voxelsOf(volume)[0] = -3;
  const std::size_t hole = volume.geometry.index(Cell(31, 31, 31));
  voxelsOf(volume)[hole] = -1;  // which no path of padding connects with a face
  const ContinuedVolume out = continued(volume);
  ASSERT_TRUE(out);
  EXPECT_FALSE(out->geometry.isImage(0));
  EXPECT_TRUE(out->geometry.isImage(hole));
  EXPECT_FALSE(out->geometry.containsIndex({0, 31, 31}));
  EXPECT_TRUE(out->geometry.containsIndex({31, 31, 31}));
  EXPECT_FALSE(hasBorder(*out));  // nothing is left to continue
}

TEST(ImageRegion, TheImageGoesOnWithoutAStep) {
  Volume volume = cut(kShapes[2], -1024);
  const ContinuedVolume out = continued(volume);
  ASSERT_TRUE(out);
  const auto& voxels = std::get<std::vector<std::int16_t>>(out->voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (out->geometry.isImage(i))
      ASSERT_EQ(voxels[i], voxelsOf(volume)[i]);
    else
      ASSERT_GT(voxels[i], kTissue - 4 * kNoise);
  }
}

TEST(ImageRegion, NoiseAndLevelAreThoseOfTheImage) {
  const Volume volume = cut([](const Vector3d& p) { return p.x() < 34 && p.y() < 44; }, 0);
  EXPECT_NEAR(Background(*continued(volume), 1, Progress()).noise(), kNoise, 1);
}

TEST(ImageRegion, OneVesselIsFoundFromBorderToBorder) {
  for (const Inside& isInside : kShapes)
    for (const std::int16_t fill : kFills) {
      Progress silent;
      const FoundVessels found = findVessels(cut(isInside, fill), false, {}, silent);
      ASSERT_EQ(found.courses.size(), 1U) << fill;
      for (const SeedPoint& point : found.courses[0].points)
        EXPECT_TRUE(found.geometry.containsWorld(point.position)) << fill;
      for (const SeedPoint& end : {found.courses[0].points.front(), found.courses[0].points.back()})
        EXPECT_TRUE(found.geometry.isBesideNoImage(
            VolumeGeometry::nearestCell(found.geometry.indexFromWorld(end.position))))
            << fill;
    }
}

// A phantom without noise whose grid stood upright (upright_grid.h): its tissue fills it, too.
TEST(ImageRegion, WhatThePaddingTookIsNoImageThatAnotherFillLeaves) {
  Volume volume = drawVolume(kSize, 1, [](const Vector3d& p) {
    return capsule(p, {-9, 20, 24}, {72, 42, 38}, 3);
  });
  fillOutside(
      volume, [](const Vector3d& p) { return p.x() + p.y() > 40; }, -1024);
  volume.padding = {-1024.0F, -1024.0F};
  const ContinuedVolume found = continued(volume);
  ASSERT_TRUE(found);
  for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i)
    ASSERT_EQ((*found->geometry.image)[i], voxelsOf(volume)[i] != -1024) << i;
}

}  // namespace
}  // namespace lumen::convert
