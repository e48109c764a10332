// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/local_model.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen::convert::fitting {
namespace {

using formats::Vec3d;

constexpr Vec3d kAlongX{1, 0, 0};

std::vector<Vec3d> spherePoints(double radius) {
  std::vector<Vec3d> points;
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const Vec3d v{random.normal(), random.normal(), random.normal()};
    const double s = radius / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    points.push_back({s * v.x, s * v.y, s * v.z});
  }
  return points;
}

/// An open tube of radius 1 along x.
std::vector<Vec3d> tubePoints(double noise) {
  std::vector<Vec3d> points;
  Random random(9);
  for (int i = 0; i < 450; ++i) {
    const double angle = random.uniform(0, 6.283185307179586);
    const double r = 1 + noise * random.normal();
    points.push_back({random.uniform(-1.9, 1.9), r * std::cos(angle), r * std::sin(angle)});
  }
  return points;
}

LocalModel fitted(const NodeData& node, const LocalModelOptions& options = {}) {
  FitWorkspace workspace;
  return fitLocalModel(options, node, Progress(), workspace);
}

double fieldAt(std::span<const Blob> blobs, const Vec3d& p) {
  double f = 0;
  for (const Blob& b : blobs) {
    const double dx = p.x - b.x, dy = p.y - b.y, dz = p.z - b.z;
    const double x = (dx * dx + dy * dy + dz * dz) / (b.width * b.width);
    f += b.width * formats::evaluateKernel(formats::Kernel::Cauchy, 0.2, x).phi;
  }
  return f;
}

/// Mean distance of the surface from (x, 0, 0) across x.
double radiusAt(std::span<const Blob> blobs, double x) {
  constexpr int kRays = 16;
  double sum = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double y = std::cos(0.3927 * ray), z = std::sin(0.3927 * ray);
    double low = 0, high = 4;
    for (int i = 0; i < 50; ++i) {
      const double r = 0.5 * (low + high);
      (fieldAt(blobs, {x, r * y, r * z}) > 0.1 ? low : high) = r;
    }
    sum += low;
  }
  return sum / kRays;
}

TEST(Split, TwoHalvesHaveTheSurfaceOfTheirBlob) {
  const Blob whole{0, 0, 0, 0.5};
  const double radius = formats::isoRadius(formats::Kernel::Cauchy, 0.2, whole.width, 0.1);
  const auto [first, second] = splitBlob({}, {0, 5, 0}, whole);
  EXPECT_EQ(first.width, second.width);
  EXPECT_NEAR(fieldAt(std::vector<Blob>{first, first}, {0, 0, radius}), 0.1, 1e-12);
}

TEST(Split, TheSecondHalfMovesByATenthOfTheWidthTowardsThePoint) {
  const auto [first, second] = splitBlob({}, {0, 5, 0}, {0, 0, 0, 0.5});
  EXPECT_EQ(first.y, 0);
  EXPECT_NEAR(second.y, 0.05, 1e-15);
  EXPECT_EQ(second.x, 0);
}

TEST(Split, ABlobThatNeverReachesTheLevelIsHalved) {
  EXPECT_EQ(splitBlob({}, {0, 5, 0}, {0, 0, 0, 0.08}).first.width, 0.04);
}

TEST(Split, APointInTheCentreStillPartsTheHalves) {
  EXPECT_NEAR(splitBlob({}, {1, 2, 3}, {1, 2, 3, 0.5}).second.x, 1.05, 1e-15);
}

TEST(LocalModel, NoPointsGiveTwoBlobsAsWideAsTheNode) {
  const auto blobs = fitted({{}, 1, kAlongX, {}}).blobs;
  ASSERT_EQ(blobs.size(), 2U);
  EXPECT_EQ(blobs[0].x, -0.5);
  EXPECT_EQ(blobs[1].x, 0.5);
  // in one place, both together would reach the level at the node's radius
  const std::vector<Blob> together{{0, 0, 0, blobs[0].width}, {0, 0, 0, blobs[1].width}};
  EXPECT_NEAR(radiusAt(together, 0), 1, 1e-9);
}

TEST(LocalModel, SevenPointsAreTooFew) {
  const std::vector<Vec3d> points(7, Vec3d{0, 0, 3});
  EXPECT_EQ(fitted({points, 1, kAlongX, {}}).blobs[0].x, -0.5);
}

TEST(LocalModel, EightEqualPointsGiveAFiniteModel) {
  const std::vector<Vec3d> points(8, Vec3d{0, 0, 1});
  for (const Blob& b : fitted({points, 1, kAlongX, {}}).blobs) {
    EXPECT_TRUE(std::isfinite(b.x + b.y + b.z + b.width));
    EXPECT_GT(b.width, 0);
  }
}

TEST(LocalModel, ReproducesASphereToAThousandth) {
  LocalModelOptions options;
  options.energy.cohesionWeight = options.energy.curvatureWeight = 0;
  options.accuracy = 1e-3;
  const auto blobs = fitted({spherePoints(1), 1, kAlongX, {}}, options).blobs;
  for (const Vec3d& p : spherePoints(1)) {
    const double outward = fieldAt(blobs, {1.001 * p.x, 1.001 * p.y, 1.001 * p.z});
    const double inward = fieldAt(blobs, {0.999 * p.x, 0.999 * p.y, 0.999 * p.z});
    EXPECT_TRUE(outward < 0.1 && inward > 0.1);
  }
}

TEST(LocalModel, ATubeIsAsWideAtItsNodeAsItsPoints) {
  const auto blobs = fitted({tubePoints(0.05), 1, kAlongX, {}}).blobs;
  for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) EXPECT_NEAR(radiusAt(blobs, x), 1, 0.04);
}

TEST(LocalModel, AFewOutliersDoNotMoveTheWall) {
  std::vector<Vec3d> points = tubePoints(0.05);
  for (const double x : {-0.8, 0.0, 0.9}) points.push_back({x, 1.6, 0});
  const auto blobs = fitted({points, 1, kAlongX, {}}).blobs;
  for (const double x : {-0.5, 0.0, 0.5}) EXPECT_NEAR(radiusAt(blobs, x), 1, 0.05);
}

TEST(LocalModel, AWrongStartingRadiusDoesNotMatter) {
  for (const double radius : {0.7, 1.0, 1.4}) {
    EXPECT_NEAR(radiusAt(fitted({tubePoints(0.05), radius, kAlongX, {}}).blobs, 0), 1, 0.04)
        << radius;
  }
}

/// The start of a tube of radius 0.15 along x, and its parent's wall, of radius 0.3 along y, around
/// (-2, 3.5, 0): a branch whose first click was far from the fork.
struct FarFork {
  std::vector<Vec3d> points;
  std::vector<FitBall> lumen{{{0, 0, 0}, 0.15},   {{-2, 3.5, 0}, 0.3}, {{0.15, 0, 0}, 0.15},
                             {{-2, 3.8, 0}, 0.3}, {{-2, 3.2, 0}, 0.3}, {{0.3, 0, 0}, 0.15}};
  FarFork() {
    Random random(10);
    for (int i = 0; i < 150; ++i) {
      const double angle = random.uniform(0, 6.283185307179586);
      const double c = std::cos(angle), s = std::sin(angle);
      points.push_back({-2 + 0.3 * c, 3.5 + random.uniform(-0.6, 0.6), 0.3 * s});
      points.push_back({random.uniform(-0.1, 0.4), 0.15 * c, 0.15 * s});
    }
  }
};

TEST(LocalModel, ABranchThatStartsFarFromItsParentCoversBoth) {
  const FarFork fork;
  const auto blobs = fitted({fork.points, 0.15, kAlongX, fork.lumen}).blobs;
  EXPECT_GT(fieldAt(blobs, {-2, 3.5, 0.25}), 0.1);
  EXPECT_LT(fieldAt(blobs, {-2, 3.5, 0.35}), 0.1);
  EXPECT_GT(fieldAt(blobs, {0.15, 0, 0.12}), 0.1);
  EXPECT_LT(fieldAt(blobs, {0.15, 0, 0.18}), 0.1);
}

TEST(LocalModel, NoSubdivisionLeavesTwoBlobs) {
  LocalModelOptions options;
  options.maxSubdivisions = 0;
  const LocalModel model = fitted({tubePoints(0), 1, kAlongX, {}}, options);
  EXPECT_EQ(model.blobs.size(), 2U);
  EXPECT_EQ(model.subdivisions, 0);
}

TEST(LocalModel, MoreSubdivisionsNeverEndAtAHigherEnergy) {
  double previous = 1e300;
  for (const int subdivisions : {0, 1, 2, 4}) {
    LocalModelOptions options;
    options.maxSubdivisions = subdivisions;
    options.accuracy = 0.01;
    const double energy = fitted({tubePoints(0.02), 1, kAlongX, {}}, options).energy;
    EXPECT_LE(energy, 1.001 * previous);
    previous = energy;
  }
}

TEST(LocalModel, AFitDoesNotDependOnTheOneBefore) {
  const auto fit = [](std::vector<Vec3d> points, double radius, FitWorkspace& workspace) {
    return fitLocalModel({}, {points, radius, kAlongX, {}}, Progress(), workspace).blobs;
  };
  FitWorkspace fresh, used;
  const auto expected = fit(tubePoints(0.05), 1, fresh);
  fit(spherePoints(2), 2, used);
  const auto found = fit(tubePoints(0.05), 1, used);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].x, expected[i].x);
    EXPECT_EQ(found[i].width, expected[i].width);
  }
}

TEST(LocalModel, BlobsOfAFitLieWithinMaxDistance) {
  LocalModelOptions options;
  options.maxDistance = 1.2;
  for (const Blob& b : fitted({tubePoints(0), 1, kAlongX, {}}, options).blobs) {
    EXPECT_LE(std::sqrt(b.x * b.x + b.y * b.y + b.z * b.z), 1.2);
  }
}

}  // namespace
}  // namespace lumen::convert::fitting
