// SPDX-License-Identifier: Apache-2.0
// Synthetic computed tomograms of a thin vessel that touches bone and runs through it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/stages/finding/bone_rim.h"
#include "converters/stages/finding/find_vessels.h"
#include "converters/stages/finding/recentre.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/voxels/trilinear.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kHeadSize = 72;
constexpr double kSoft = 40, kBlood = 340, kBone = 1100, kGrain = 8, kThin = 1.6;

/// The vessel, of radius 1.6 voxels.
double artery(const Vector3d& p) {
  return capsule(p, {12, 30, 36}, {60, 42, 36}, kThin);
}
double petrous(const Vector3d& p) {
  return inBox(p, {27, 24, 24}, {45, 48, 48});
}

/// Bone is uneven over two voxels, as no blood is.
double unevenBone(const Vector3d& p) {
  const Eigen::Vector3i cell = (0.5 * p).array().floor().cast<int>().matrix();
  const auto seed = static_cast<std::uint64_t>(cell[0] + 100 * (cell[1] + 100 * cell[2]));
  return kBone + 150 * Random(seed).normal();
}

Volume head(double calcium = 0) {
  Volume volume;
  volume.geometry.size = {kHeadSize, kHeadSize, kHeadSize};
  Random random(5);
  std::vector<std::int16_t> voxels;
  volume.geometry.cells().forEach([&](const Cell& cell) {
    const Vector3d p = cell.cast<double>();
    double value = -1000;
    mix(value, kSoft, (p - Vector3d(36, 36, 36)).norm() - 34);
    mix(value, unevenBone(p), petrous(p));
    mix(value, kBlood, artery(p));
    if (calcium > 0) mix(value, calcium, (p - Vector3d(20, 33.9, 36)).norm() - 1.2);
    voxels.push_back(static_cast<std::int16_t>(std::lround(value + kGrain * random.normal())));
  });
  volume.voxels = std::move(voxels);
  return volume;
}

TrackResult tracked(const Volume& volume) {
  Progress silent;
  const FoundVessels found = findVessels(volume, false, {}, silent);
  return trackAlongCourses(found.tracked(volume), found.courses, {}, {}, silent);
}

/// The node of a case nearest to a place.
std::size_t nearestNode(const formats::CenterlineTree& tree, const Vector3d& place) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const double away = (toEigen(tree.centre[n]) - place).norm();
    if (away < least) best = n;
    least = std::min(least, away);
  }
  return best;
}

TEST(BesideBone, AVesselKeepsItsCourseAndItsWidthThroughBone) {
  const formats::CenterlineTree tree = tracked(head()).result.tree;
  ASSERT_GT(tree.nodeCount(), 0U);
  for (double x = 16; x <= 56; x += 2) {
    const Vector3d axis(x, 30 + (x - 12) / 4, 36);
    const std::size_t n = nearestNode(tree, axis);
    EXPECT_LT((toEigen(tree.centre[n]) - axis).norm(), 1.2) << x;
    EXPECT_NEAR(static_cast<double>(tree.radius[n]), kThin, 0.45) << x;
  }
}

TEST(BesideBone, ItsRimIsNoVessel) {
  Progress silent;
  for (const SeedBranch& course : findVessels(head(), false, {}, silent).courses)
    for (const SeedPoint& point : course.points)
      EXPECT_LT(artery(point.position), 1.5) << point.position.transpose();
}

TEST(BesideBone, CalciumIsDarkerThanBloodWhereVesselsAreTracked) {
  Progress silent;
  const Volume volume = head(900);
  const FoundVessels found = findVessels(volume, false, {}, silent);
  ASSERT_TRUE(found.folded);
  const auto at = [&](const Cell& cell) {
    return std::get<std::vector<std::int16_t>>(
        found.tracked(volume).voxels)[volume.geometry.cells().index(cell)];
  };
  EXPECT_LT(at({20, 34, 36}), kSoft);
  EXPECT_NEAR(at({16, 31, 36}), kBlood, 4 * kGrain) << "blood stays as it is";
  EXPECT_NEAR(at({36, 60, 36}), kSoft, 5 * kGrain) << "so does soft tissue";
}

TEST(BoneRim, IsWhereTheLevelOfBloodPassesOnToBone) {
  const Volume volume = head();
  const BoneRim rim(volume, kSoft, kBlood);
  EXPECT_TRUE(rim.isOn(Cell(36, 48, 44)));
  EXPECT_TRUE(rim.isOn(Vector3d(36, 48, 44)));
  EXPECT_TRUE(rim.isOn(Vector3d(36, 44, 44))) << "within bone";
  EXPECT_FALSE(rim.isOn(Vector3d(36, 36, 36))) << "the middle of a vessel in bone";
  EXPECT_FALSE(rim.isOn(Vector3d(20, 32, 36))) << "one apart from it";
  EXPECT_FALSE(rim.isOn(Cell(36, 36, 36)));
}

TEST(Recentre, MovesThinVesselsOntoTheirRidge) {
  VolumeGeometry grid;
  grid.size = {30, 20, 20};
  ZeroedArray<float> strength(grid.voxelCount());
  grid.cells().forEach([&](const Cell& cell) {
    const Vector3d off(0, cell[1] - 10.5, cell[2] - 9);
    strength[grid.cells().index(cell)] = static_cast<float>(std::exp(-0.25 * off.squaredNorm()));
  });
  std::vector<SeedPoint> points, wide;
  for (int x = 2; x < 28; ++x) {
    points.push_back({Vector3d(x, 11.7, 10), 1.0});
    wide.push_back({Vector3d(x, 11.7, 10), 2.5});
  }
  recentre(grid, strength, points);
  recentre(grid, strength, wide);
  EXPECT_LT((points[12].position - Vector3d(14, 10.5, 9)).norm(), 0.2);
  EXPECT_EQ(points[0].position, Vector3d(2, 11.7, 10));
  EXPECT_LT((wide[12].position - Vector3d(14, 11.7, 10)).norm(), 1e-9);
}

TEST(Trilinear, IsExactForPlanesAndConstantBeyondTheCells) {
  const CellBox cells{Cell::Zero(), Cell(4, 5, 6)};
  const auto plane = [](const Cell& cell) { return cell[0] + 2 * cell[1] - 3 * cell[2]; };
  EXPECT_DOUBLE_EQ(trilinear(cells, {1.25, 2.5, 3.75}, plane), 1.25 + 5 - 11.25);
  EXPECT_DOUBLE_EQ(trilinear(cells, {-2, 4, 9}, plane), 8 - 15);
}

}  // namespace
}  // namespace lumen::convert
