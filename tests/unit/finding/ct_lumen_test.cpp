// SPDX-License-Identifier: Apache-2.0
// Synthetic computed tomograms: vessels, an organ and bone in soft tissue, with air around it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/finding/ct_levels.h"
#include "converters/stages/finding/find_vessels.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kScanSize = 80;
constexpr double kScanNoise = 10, kSoftTissue = 40;

// A wide vessel, its branch, and another thin one that hangs on nothing.
double aorta(const Vector3d& p) {
  return capsule(p, {22, 40, -9}, {22, 40, 90}, 6);
}
double branch(const Vector3d& p) {
  return capsule(p, {22, 40, 30}, {45, 14, 40}, 1.5);
}
double apart(const Vector3d& p) {
  return capsule(p, {50, 16, 50}, {16, 64, 66}, 1.5);
}
double organ(const Vector3d& p) {
  return (p - Vector3d(52, 18, 20)).norm() - 9;
}
double inBone(const Vector3d& p) {
  return capsule(p, {57, 57, 16}, {57, 57, 64}, 1.5);
}
double bone(const Vector3d& p) {
  return inBox(p, {44, 44, 8}, {70, 70, 72});
}

struct Scene {
  double blood = 350;  ///< Hounsfield units
  double organ = 140;
  double offset = 0;  ///< added to every voxel
  bool hasVessels = true;
  bool hasVesselInBone = false;
  bool hasEvenMarrow = false;  ///< in a cube of six voxels
};

/// Marrow is a texture of two voxels, the cortex around it two voxels thick.
double boneLevel(const Vector3d& p) {
  if (bone(p) > -2) return 900;
  const Eigen::Vector3i cell = (0.5 * p).array().floor().cast<int>().matrix();
  const auto seed = static_cast<std::uint64_t>(cell[0] + 100 * (cell[1] + 100 * cell[2]));
  return 220 + 120 * Random(seed).normal();
}

Volume draw(const Scene& scene) {
  Volume volume;
  volume.geometry.size = {kScanSize, kScanSize, kScanSize};
  Random random(3);
  std::vector<std::int16_t> voxels;
  volume.geometry.cells().forEach([&](const Cell& cell) {
    const Vector3d p = cell.cast<double>();
    double value = -1000;
    mix(value, kSoftTissue, inBox(p, {6, 6, -9}, {74, 74, 90}));
    mix(value, scene.organ, organ(p));
    mix(value, boneLevel(p), bone(p));
    if (scene.hasEvenMarrow) mix(value, 320, inBox(p, {54, 54, 37}, {60, 60, 43}));
    if (scene.hasVesselInBone) mix(value, scene.blood, inBone(p));
    if (scene.hasVessels) mix(value, scene.blood, std::min({aorta(p), branch(p), apart(p)}));
    voxels.push_back(static_cast<std::int16_t>(
        std::lround(value + scene.offset + kScanNoise * random.normal())));
  });
  volume.voxels = std::move(voxels);
  return volume;
}

FoundVessels found(const Scene& scene, const Prior& prior = {}) {
  Progress silent;
  return findVessels(draw(scene), false, prior, silent);
}

std::optional<CtLevels> levels(const Volume& volume) {
  return measureCtLevels(volume, Progress());
}

/// The greatest distance of a place on the way from a to b to the courses.
double farthest(const FoundVessels& vessels, const Vector3d& a, const Vector3d& b) {
  double most = 0;
  for (double t = 0; t <= 1; t += 0.1) {
    double least = std::numeric_limits<double>::infinity();
    for (const SeedBranch& course : vessels.courses)
      for (const SeedPoint& point : course.points)
        least = std::min(least, (point.position - a - t * (b - a)).norm());
    most = std::max(most, least);
  }
  return most;
}

void expectVesselsAlone(const FoundVessels& vessels) {
  EXPECT_LT(farthest(vessels, {22, 40, 4}, {22, 40, 75}), 2);
  EXPECT_LT(farthest(vessels, {30, 30.96, 33.5}, {43, 16.3, 39.1}), 2);
  EXPECT_LT(farthest(vessels, {47, 20.2, 51.4}, {19, 59.8, 64.6}), 2);
  for (const SeedBranch& course : vessels.courses)
    for (const SeedPoint& point : course.points)
      EXPECT_LT(std::min({aorta(point.position), branch(point.position), apart(point.position)}), 1)
          << point.position.transpose();
}

TEST(CtLevels, AreThoseOfSoftTissue) {
  for (const double offset : {0.0, 1000.0, 1024.0}) {
    const auto found = levels(draw({.offset = offset}));
    ASSERT_TRUE(found) << offset;
    EXPECT_NEAR(static_cast<double>(found->soft), kSoftTissue + offset, 10) << offset;
    EXPECT_NEAR(static_cast<double>(found->noise), kScanNoise, 2) << offset;
  }
}

TEST(CtLevels, OtherVolumesHaveNone) {
  EXPECT_FALSE(levels(drawVolume(64, 1, aorta)));
  EXPECT_FALSE(levels(noisy(drawVolume(64, 1, aorta), 50)));
  EXPECT_FALSE(levels(draw({.offset = 300})));
}

TEST(CtLumen, VesselsAreFoundAndBoneIsNot) {
  const FoundVessels vessels = found({});
  expectVesselsAlone(vessels);
  EXPECT_TRUE(vessels.isBone({45, 57, 40}));
  EXPECT_FALSE(vessels.isLumen({57, 57, 40}));
  EXPECT_FALSE(vessels.isLumen({52, 18, 20})) << "an organ of less than half of the contrast";
}

// Marrow may be even by chance, but not along ten voxels.
TEST(CtLumen, AnEvenPlaceInMarrowIsNoLumen) {
  const FoundVessels vessels = found({.hasEvenMarrow = true});
  EXPECT_FALSE(vessels.isLumen({57, 57, 40}));
  EXPECT_TRUE(vessels.isBone({57, 57, 40}));
}

TEST(CtLumen, AnOffsetChangesNothing) {
  expectVesselsAlone(found({.offset = 1024}));
}

TEST(CtLumen, FaintContrastIsFound) {
  expectVesselsAlone(found({.blood = 190, .organ = 60}));
}

TEST(CtLumen, WithoutContrastNothingIsFound) {
  EXPECT_TRUE(found({.organ = 70, .hasVessels = false}).courses.empty());
  EXPECT_TRUE(found({.blood = 50, .organ = 70}).courses.empty());
}

// Bone is as bright and as uneven as a thin vessel within it: a coarse map alone shows which is which.
TEST(CtLumen, AVesselThroughBoneIsFoundByItsMap) {
  const Scene scene{.hasVesselInBone = true};
  Prior prior;
  const VolumeGeometry geometry = draw(scene).geometry;
  geometry.cells().forEach([&](const Cell& cell) {
    prior.systems.push_back(inBone(geometry.position(cell) + Vector3d::UnitX()) < 1 ? 1 : 0);
  });
  EXPECT_GT(farthest(found(scene), {57, 57, 20}, {57, 57, 60}), 9);
  EXPECT_LT(farthest(found(scene, prior), {57, 57, 20}, {57, 57, 60}), 3);
}

TEST(CtLumen, NoLumenLiesWhereAMapHasNoVessel) {
  Prior prior;
  const VolumeGeometry geometry = draw({}).geometry;
  geometry.cells().forEach([&](const Cell& cell) {
    prior.systems.push_back(aorta(geometry.position(cell)) < 3 ? Prior::kNoVessel : 0);
  });
  const FoundVessels vessels = found({}, prior);
  for (const std::size_t i : vessels.lumen) EXPECT_NE(prior.systems[i], Prior::kNoVessel);
  EXPECT_TRUE(vessels.isBone({22, 40, 40}));
  EXPECT_LT(farthest(vessels, {47, 20.2, 51.4}, {35, 37, 57}), 2);
}

}  // namespace
}  // namespace lumen::convert
