// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/image_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/finding/background.h"
#include "converters/stages/finding/find_vessels.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Inside = std::function<bool(const Vector3d&)>;

constexpr int kSize = 64;
constexpr double kTissue = 300, kNoise = 20;
const Vector3d kMiddle(31.5, 31.5, 31.5);

/// Shapes of an image: one that stands, one that is turned, one without a flat side.
const std::vector<Inside> kShapes = {
    [](const Vector3d& p) { return (p - kMiddle).head<2>().norm() < 28; },
    [](const Vector3d& p) {
      const Vector3d q = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()) * (p - kMiddle);
      return q.cwiseAbs().maxCoeff() < 24;
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

bool hasBorder(const Volume& volume) {
  return !findImage(volume, Progress()).isImage.empty();
}

TEST(ImageRegion, IsWhatNoFillCoversWhateverItsShapeAndValue) {
  for (const Inside& isInside : kShapes)
    for (const std::int16_t fill : kFills) {
      const Volume volume = cut(isInside, fill);
      const ImageRegion image = findImage(volume, Progress());
      ASSERT_EQ(image.isImage.size(), volume.geometry.voxelCount()) << fill;
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < image.isImage.size(); ++i)
        if (image.holds(i) != isInside(volume.geometry.position(volume.geometry.cell(i)))) ++wrong;
      EXPECT_EQ(wrong, 0U) << fill;
      ASSERT_EQ(image.sentences.size(), 1U);
      EXPECT_NE(image.sentences[0].find("voxels of " + std::to_string(fill) + " are no image"),
                std::string::npos)
          << image.sentences[0];
    }
}

TEST(ImageRegion, AFillOfTheMeanIsKnownButForSingleEqualVoxelsBesideIt) {
  const Volume volume = cut(kShapes[0], static_cast<std::int16_t>(kTissue));
  const ImageRegion image = findImage(volume, Progress());
  ASSERT_FALSE(image.isImage.empty());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < image.isImage.size(); ++i)
    if (image.holds(i) != kShapes[0](volume.geometry.position(volume.geometry.cell(i)))) ++wrong;
  EXPECT_LT(wrong, volume.geometry.voxelCount() / 500);
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
}

TEST(ImageRegion, AnImageThatFadesIntoTheValueHasNoBorder) {
  const auto faded = [](double share) {  // of the tissue, in the outermost voxel of a circle
    Volume volume = vesselInTissue();
    for (std::size_t i = 0; i < voxelsOf(volume).size(); ++i) {
      const Vector3d p = volume.geometry.position(volume.geometry.cell(i));
      const double radius = (p - kMiddle).head<2>().norm();
      if (radius > 27) voxelsOf(volume)[i] = static_cast<std::int16_t>(share * voxelsOf(volume)[i]);
      if (radius > 28) voxelsOf(volume)[i] = 0;
    }
    return volume;
  };
  EXPECT_TRUE(hasBorder(faded(0.92)));
  EXPECT_FALSE(hasBorder(faded(0.68)));
}

TEST(ImageRegion, IsThick) {
  const auto circle = [](double radius) {
    return cut([=](const Vector3d& p) { return (p - kMiddle).head<2>().norm() < radius; }, 0);
  };
  EXPECT_TRUE(hasBorder(circle(11.5)));  // a tube of .39 radii: 4.5 voxels for each face
  EXPECT_FALSE(hasBorder(circle(8.8)));  // 3.4
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

TEST(ImageRegion, AFillIsFourVoxelsThick) {
  const auto layers = [](int thick) {
    return cut([=](const Vector3d& p) { return p.z() > thick - 0.5; }, 0);
  };
  EXPECT_TRUE(hasBorder(layers(4)));
  EXPECT_FALSE(hasBorder(layers(3)));
}

TEST(ImageRegion, FewRowsAreNoEvidence) {
  const auto corner = [](const Cell& box) {
    return cut(
        [=](const Vector3d& p) { return (p.array() > box.cast<double>().array() - 0.5).any(); }, 0);
  };
  EXPECT_TRUE(hasBorder(corner({6, 6, 6})));   // 108 rows
  EXPECT_FALSE(hasBorder(corner({5, 6, 6})));  // 96 rows
}

TEST(ImageRegion, TheImageGoesOnWithoutAStep) {
  const Volume volume = cut(kShapes[2], -1024);
  const ImageRegion image = findImage(volume, Progress());
  const auto& voxels = std::get<std::vector<std::int16_t>>(image.without(volume).voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (image.holds(i))
      ASSERT_EQ(voxels[i], std::get<std::vector<std::int16_t>>(volume.voxels)[i]);
    else
      ASSERT_GT(voxels[i], kTissue - 4 * kNoise);
  }
}

TEST(ImageRegion, NoiseAndLevelAreThoseOfTheImage) {
  const Volume volume = cut([](const Vector3d& p) { return p.x() < 34 && p.y() < 44; }, 0);
  const ImageRegion image = findImage(volume, Progress());
  EXPECT_NEAR(Background(image.without(volume), 1, Progress(), image).noise(), kNoise, 1);
}

TEST(ImageRegion, OneVesselIsFoundWhichEndsAQuarterOfItsRadiusPastTheBorder) {
  for (const Inside& isInside : kShapes)
    for (const std::int16_t fill : kFills) {
      Progress silent;
      const FoundVessels found = findVessels(cut(isInside, fill), false, silent);
      ASSERT_EQ(found.courses.size(), 1U) << fill;
      std::vector<SeedPoint> points = found.courses[0].points;
      for (std::size_t i = 1; i + 1 < points.size(); ++i)
        EXPECT_TRUE(found.isImage(points[i].position)) << fill;
      for (int end = 0; end < 2; ++end) {
        const SeedPoint last = points.back(), atBorder = points[points.size() - 2];
        const Vector3d past = last.position - atBorder.position;
        EXPECT_NEAR(past.norm(), 0.25 * *last.radius, 1e-9) << fill;
        EXPECT_FALSE(found.isImage(atBorder.position + 2.5 * past.normalized())) << fill;
        std::reverse(points.begin(), points.end());
      }
    }
}

}  // namespace
}  // namespace lumen::convert
