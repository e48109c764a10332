// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/find_vessels.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/random.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// A trunk of radius 3 along z with a branch of radius 1.2 that leaves it half way up.
double fork(const Vector3d& p) {
  return std::min(capsule(p, {24, 30, 4}, {24, 30, 60}, 3),
                  capsule(p, {24, 30, 30}, {46, 30, 44}, 1.2));
}

std::vector<SeedBranch> find(const Volume& volume, bool dark = false) {
  Progress silent;
  return findVessels(volume, dark, {}, silent).courses;
}

double distanceFrom(const SeedBranch& course, const Vector3d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const SeedPoint& point : course.points)
    least = std::min(least, (point.position - place).norm());
  return least;
}

void expectFork(const std::vector<SeedBranch>& courses) {
  ASSERT_EQ(courses.size(), 2U);
  EXPECT_FALSE(courses[0].parent);
  EXPECT_EQ(courses[1].parent, courses[0].label);
  EXPECT_LT(distanceFrom(courses[0], {24, 30, 8}), 2);
  EXPECT_LT(distanceFrom(courses[0], {24, 30, 56}), 2);
  EXPECT_LT(distanceFrom(courses[1], {44, 30, 42.73}), 2);
  for (const SeedBranch& course : courses)
    for (const SeedPoint& point : course.points) EXPECT_GT(point.radius.value_or(0), 0);
}

TEST(FindVessels, AForkIsATrunkAndAChild) {
  expectFork(find(drawVolume(64, 1, fork)));
}

TEST(FindVessels, DarkVesselsAreFoundAsBrightOnes) {
  Volume volume = drawVolume(64, 1, fork);
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(volume.voxels))
    voxel = static_cast<std::int16_t>(1200 - voxel);
  expectFork(find(volume, true));
}

TEST(FindVessels, AVesselOfAFifthOfTheContrastIsFound) {
  const Volume bright = drawVolume(64, 1, [](const Vector3d& p) {
    return capsule(p, {16, 16, 4}, {16, 16, 60}, 4);
  });
  Volume both = drawVolume(64, 1, [](const Vector3d& p) {
    return capsule(p, {46, 46, 4}, {46, 46, 60}, 1.5);
  });
  auto& voxels = std::get<std::vector<std::int16_t>>(both.voxels);
  const auto& wide = std::get<std::vector<std::int16_t>>(bright.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::int16_t>(voxels[i] / 5 + wide[i]);
  const auto courses = find(both);
  ASSERT_EQ(courses.size(), 2U);
  EXPECT_LT(
      std::min(distanceFrom(courses[0], {46, 46, 32}), distanceFrom(courses[1], {46, 46, 32})),
      1.5);
}

TEST(FindVessels, AWideVesselThatFadesIsFoundToItsEnd) {
  Volume volume = drawVolume(96, 1, [](const Vector3d& p) {
    return std::min(capsule(p, {24, 24, 4}, {24, 24, 92}, 5),
                    capsule(p, {70, 70, 4}, {70, 70, 92}, 5));
  });
  // the first one keeps a fifth of its brightness at its end
  const CellBox cells = volume.geometry.cells();
  cells.forEach([&](const Cell& cell) {
    std::int16_t& voxel = std::get<std::vector<std::int16_t>>(volume.voxels)[cells.index(cell)];
    if (cell[0] < 48 && cell[2] > 32)
      voxel = static_cast<std::int16_t>(voxel * (112 - cell[2]) / 80);
  });
  const auto courses = find(volume);
  ASSERT_EQ(courses.size(), 2U);
  for (const SeedBranch& course : courses) {
    const bool fades = course.points[0].position.x() < 48;
    const double at = fades ? 24 : 70;
    EXPECT_LT(distanceFrom(course, {at, at, 88}), 4) << (fades ? "the fading one" : "the other");
  }
}

TEST(FindVessels, AFadedVesselIsFoundWhereHalfOfItIsNoise) {
  Random random(7, 0);
  Volume volume = drawVolume(96, 1, [](const Vector3d& p) {
    return std::min(capsule(p, {24, 24, 4}, {24, 24, 120}, 10),
                    capsule(p, {70, 70, 4}, {70, 70, 92}, 5));
  });
  // less than a third of the first one's brightness is left, and half of that is no more than noise
  const CellBox cells = volume.geometry.cells();
  cells.forEach([&](const Cell& cell) {
    std::int16_t& voxel = std::get<std::vector<std::int16_t>>(volume.voxels)[cells.index(cell)];
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    const double share = cell[0] < 48 ? std::clamp((86.0 - cell[2]) / 60, 0.3, 1.0) : 1;
    voxel = static_cast<std::int16_t>(std::lround(500 + share * voxel + 45 * sum));
  });
  const auto courses = find(volume);
  for (const double z : {64.0, 72.0, 80.0, 88.0}) {
    double least = std::numeric_limits<double>::infinity();
    for (const SeedBranch& course : courses)
      least = std::min(least, distanceFrom(course, {24, 24, z}));
    EXPECT_LT(least, 5) << z;
  }
}

/// Expects the first and the last point of a course at two places, in either order.
void expectEndsAt(const SeedBranch& course, Vector3d low, Vector3d high) {
  const Vector3d first = course.points.front().position, last = course.points.back().position;
  if ((first - low).norm() > (first - high).norm()) std::swap(low, high);
  EXPECT_LT((first - low).norm(), 1.5) << first.transpose();
  EXPECT_LT((last - high).norm(), 1.5) << last.transpose();
}

TEST(FindVessels, AVesselThatFacesCutEndsInTheMiddleOfItsSections) {
  const auto square = find(drawVolume(64, 1, [](const Vector3d& p) {
    return capsule(p, {30, 34, -20}, {30, 34, 90}, 9);
  }));
  ASSERT_EQ(square.size(), 1U);
  expectEndsAt(square[0], {30, 34, 0}, {30, 34, 63});
  const auto slanted = find(drawVolume(64, 1, [](const Vector3d& p) {
    return capsule(p, {30, 16, -16}, {30, 48, 79}, 7);  // 19 degrees
  }));
  ASSERT_EQ(slanted.size(), 1U);
  expectEndsAt(slanted[0], {30, 21.4, 0}, {30, 42.6, 63});
}

/// Struts and pores of equal width, by a gyroid of a period of 10 mm.
double sponge(const Vector3d& p) {
  const Vector3d a = 0.2 * std::numbers::pi * p;
  return -2 * (std::sin(a.x()) * std::cos(a.y()) + std::sin(a.y()) * std::cos(a.z()) +
               std::sin(a.z()) * std::cos(a.x()));
}

double box(const Vector3d& p, const Vector3d& centre, const Vector3d& half) {
  return ((p - centre).cwiseAbs() - half).maxCoeff();
}

FoundVessels findBeside(const std::function<double(const Vector3d&)>& bone) {
  const Volume volume = drawVolume(80, 1, [&](const Vector3d& p) {
    return std::min(capsule(p, {15, 40, 4}, {15, 40, 76}, 2.5), bone(p));
  });
  Progress silent;
  return findVessels(volume, false, {}, silent);
}

TEST(FindVessels, APlateIsBone) {
  const FoundVessels found = findBeside([](const Vector3d& p) {
    return box(p, {45, 40, 40}, {2, 30, 30});
  });
  // its edge, as bright as a vessel, may stay
  for (const SeedBranch& course : found.courses) EXPECT_GT(distanceFrom(course, {45, 40, 40}), 22);
  EXPECT_LT(distanceFrom(found.courses[0], {15, 40, 40}), 1);
  EXPECT_TRUE(found.isBone({45, 40, 40}));
  EXPECT_TRUE(found.isLumen({15, 40, 40}));
  EXPECT_FALSE(found.isBone({15, 40, 40}));
}

TEST(FindVessels, ASpongeInAShellIsBone) {
  const FoundVessels found = findBeside([](const Vector3d& p) {
    const double whole = box(p, {50, 40, 40}, {12, 30, 30});
    return std::max(whole, std::min(sponge(p), -3 - whole));
  });
  double inBone = 0, points = 0;
  for (const SeedBranch& course : found.courses)
    for (const SeedPoint& point : course.points) {
      ++points;
      inBone += point.position.x() > 25 ? 1 : 0;
    }
  EXPECT_GT(points, 60);
  EXPECT_LT(inBone, points);
  EXPECT_TRUE(found.isLumen({15, 40, 40}));
  EXPECT_TRUE(found.isBone({39, 40, 40}));
}

TEST(FindVessels, AVesselThatTouchesAPlateIsNoBone) {
  const FoundVessels found = findBeside([](const Vector3d& p) {
    return box(p, {20, 40, 40}, {2, 30, 15});  // its face is half a voxel from the vessel's wall
  });
  for (const double z : {10.0, 25.0, 40.0, 55.0, 70.0}) {
    EXPECT_FALSE(found.isBone({15, 40, z})) << z;
    EXPECT_TRUE(found.isLumen({15, 40, z})) << z;
  }
  EXPECT_TRUE(found.isBone({20, 60, 40}));
}

TEST(FindVessels, ATangleOfVesselsIsNoBone) {
  // thin vessels side by side, four radii apart
  const Volume volume = drawVolume(64, 1, [](const Vector3d& p) {
    double least = capsule(p, {8, 8, 32}, {56, 8, 32}, 2);
    for (int k = 0; k < 6; ++k)
      least = std::min(least, capsule(p, {12.0 + 8 * k, 8, 32}, {12.0 + 8 * k, 56, 32}, 2));
    return least;
  });
  Progress silent;
  EXPECT_TRUE(findVessels(volume, false, {}, silent).bone.empty());
}

/// Statements about the voxels of a volume by their places.
Prior priorOf(const Volume& volume, const std::function<std::uint8_t(const Vector3d&)>& statement) {
  Prior prior;
  volume.geometry.cells().forEach([&](const Cell& cell) {
    prior.systems.push_back(statement(volume.geometry.position(cell)));
  });
  return prior;
}

/// A place, or the same with x and z exchanged, so that voxels are numbered along other vessels first.
Vector3d turned(const Vector3d& p, bool isTurned) {
  return isTurned ? Vector3d(p.z(), p.y(), p.x()) : p;
}

/// Whether a course has a point on each side of the place where two vessels touch.
bool crossesOver(const FoundVessels& found, bool isTurned) {
  return std::any_of(found.courses.begin(), found.courses.end(), [&](const SeedBranch& course) {
    bool isLow = false, isHigh = false;
    for (const SeedPoint& point : course.points) {
      isLow = isLow || turned(point.position, isTurned).x() < 28;
      isHigh = isHigh || turned(point.position, isTurned).x() > 34;
    }
    return isLow && isHigh;
  });
}

/// Two vessels of radius 3 that touch along half of their length, as a vein beside an artery.
double besideEachOther(const Vector3d& p) {
  const double left = std::min(capsule(p, {10, 32, 4}, {28.2, 32, 20}, 3),
                               capsule(p, {28.2, 32, 20}, {28.2, 32, 60}, 3));
  const double right = std::min(capsule(p, {54, 32, 4}, {33.8, 32, 20}, 3),
                                capsule(p, {33.8, 32, 20}, {33.8, 32, 60}, 3));
  return std::min(left, right);
}

void expectTwoSystems(bool isTurned) {
  const Volume volume =
      drawVolume(64, 1, [&](const Vector3d& p) { return besideEachOther(turned(p, isTurned)); });
  Progress silent;
  EXPECT_TRUE(isTurned || crossesOver(findVessels(volume, false, {}, silent), false));
  // a coarse map: it knows of each vessel up to half of its length, a voxel beside the wall
  const Prior prior = priorOf(volume, [&](const Vector3d& place) -> std::uint8_t {
    const Vector3d p = turned(place, isTurned);
    return p.z() > 40 ? 0 : p.x() < 30 ? 1 : 2;
  });
  const FoundVessels found = findVessels(volume, false, prior, silent);
  EXPECT_FALSE(crossesOver(found, isTurned));
  EXPECT_EQ(found.systems.size(), found.lumen.size());
  for (const double x : {27.5, 34.5}) {
    double least = 100;
    for (const SeedBranch& course : found.courses)
      least = std::min(least, distanceFrom(course, turned({x, 32, 55}, isTurned)));
    EXPECT_LT(least, 2) << "both go on beyond the map";
  }
}

TEST(FindVessels, NoCourseLeadsFromOneSystemToAnother) {
  expectTwoSystems(false);
  expectTwoSystems(true);
}

TEST(FindVessels, NoCourseRunsWhereAMapStatesThatNoVesselIs) {
  const Volume volume = drawVolume(64, 1, fork);
  const auto isBranch = [](const Vector3d& p) { return p.x() > 29; };
  Progress silent;
  const FoundVessels found = findVessels(
      volume, false,
      priorOf(volume,
              [&](const Vector3d& p) { return isBranch(p) ? Prior::kNoVessel : Prior::kNothing; }),
      silent);
  ASSERT_EQ(found.courses.size(), 1U);
  for (const SeedPoint& point : found.courses[0].points) EXPECT_FALSE(isBranch(point.position));
  EXPECT_FALSE(found.isLumen({40, 30, 40}));
  EXPECT_TRUE(found.isLumen({24, 30, 40}));
}

TEST(FindVessels, NoiseHoldsNone) {
  Random random(7, 0);
  Volume volume = drawVolume(64, 1, [](const Vector3d&) { return 5.0; });
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(volume.voxels)) {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    voxel = static_cast<std::int16_t>(std::lround(500 + 50 * sum));
  }
  EXPECT_TRUE(find(volume).empty());
}

TEST(FindVessels, AnEvenVolumeHoldsNone) {
  EXPECT_TRUE(find(drawVolume(32, 1, [](const Vector3d&) { return 5.0; })).empty());
}

TEST(FindVessels, VoxelsOfUnequalEdgesKeepLengthsInMillimetres) {
  Volume volume = drawVolume(64, 1, fork);
  // every second slice
  Volume thick;
  thick.geometry = volume.geometry;
  thick.geometry.size[2] = 32;
  thick.geometry.spacing[2] = 2;
  std::vector<std::int16_t> voxels;
  const auto& all = std::get<std::vector<std::int16_t>>(volume.voxels);
  thick.geometry.cells().forEach([&](const Cell& cell) {
    voxels.push_back(all[volume.geometry.index(Cell(cell[0], cell[1], 2 * cell[2]))]);
  });
  thick.voxels = std::move(voxels);
  expectFork(find(thick));
}

TEST(FindVessels, ThreadsDoNotChangeTheCourses) {
  const Volume volume = drawVolume(96, 1, fork);
  const auto many = find(volume);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto few = find(volume);
  ASSERT_EQ(many.size(), few.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    ASSERT_EQ(many[i].points.size(), few[i].points.size());
    for (std::size_t k = 0; k < many[i].points.size(); ++k) {
      EXPECT_EQ(many[i].points[k].position, few[i].points[k].position);
      EXPECT_EQ(many[i].points[k].radius, few[i].points[k].radius);
    }
  }
}

/// Two vessels along z that touch; `from`: z at which the second begins.
FoundVessels touching(double from) {
  FoundVessels found;
  found.geometry.size = {40, 40, 60};
  found.geometry.origin = {-7, 30, 100};
  const VolumeGeometry& geometry = found.geometry;
  for (std::size_t i = 0; i < geometry.voxelCount(); ++i) {
    const Vector3d p = geometry.cell(i).cast<double>();
    if (std::min(capsule(p, {15, 20, 6}, {15, 20, 54}, 6),
                 capsule(p, {25, 20, from}, {25, 20, 54}, 4)) < 0)
      found.lumen.push_back(i);
  }
  return found;
}

std::vector<WorldBall> ballsAlong(double x, double radius) {
  std::vector<WorldBall> balls;
  for (int z = 6; z <= 54; ++z) balls.push_back({{x, 20, static_cast<double>(z)}, radius});
  return balls;
}

TEST(CoursesInRemainingLumen, FollowTheVesselThatTouchesAKnownOne) {
  Progress silent;
  const FoundVessels found = touching(6);
  const auto courses = coursesInRemainingLumen(found, ballsAlong(15, 6), silent);
  ASSERT_EQ(courses.size(), 1U);
  for (const double z : {10.0, 30.0, 50.0})
    EXPECT_LT(distanceFrom(courses[0], found.geometry.worldFromIndex({25, 20, z})), 1.5) << z;
}

TEST(CoursesInRemainingLumen, AreNoneWhereVesselsHoldTheLumen) {
  Progress silent;
  std::vector<WorldBall> balls = ballsAlong(15, 5.5);  // half a voxel of rim is a vessel's own
  const std::vector<WorldBall> second = ballsAlong(25, 3.5);
  balls.insert(balls.end(), second.begin(), second.end());
  EXPECT_TRUE(coursesInRemainingLumen(touching(6), balls, silent).empty());
}

TEST(CoursesInRemainingLumen, AStretchOfLessThanTenVoxelsIsNone) {
  Progress silent;
  EXPECT_TRUE(coursesInRemainingLumen(touching(53.5), ballsAlong(15, 6), silent).empty());
}

}  // namespace
}  // namespace lumen::convert
