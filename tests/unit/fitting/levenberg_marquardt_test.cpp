// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/levenberg_marquardt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "conjugate_gradients.h"
#include "converters/base/random.h"

namespace lumen::convert::fitting {
namespace {

using formats::Vec3d;

std::vector<Vec3d> tubePoints(double length, double noise) {
  Random random(5);
  std::vector<Vec3d> points;
  for (int i = 0; i < 400; ++i) {
    const double angle = random.uniform(0, 6.283185307179586);
    const double r = 1 + noise * random.normal();
    points.push_back(
        {random.uniform(-length / 2, length / 2), r * std::cos(angle), r * std::sin(angle)});
  }
  return points;
}

std::vector<Blob> rowOfBlobs(int count, double length) {
  std::vector<Blob> blobs;
  for (int i = 0; i < count; ++i) {
    blobs.push_back({length * ((i + 0.5) / count - 0.5), 0.05 * i, 0, 0.35});
  }
  return blobs;
}

EnergyParameters normalised(const std::vector<Vec3d>& points, const std::vector<Blob>& blobs) {
  EnergyParameters p;
  Energy plain(p);
  plain.setPoints(points);
  plain.evaluate(blobs);
  p.referenceSlope = plain.slope();
  return p;
}

TEST(SolveSymmetric, SolvesATwoByTwoSystem) {
  // 4 x + 2 y = -8, 2 x + 3 y = -8: x = -1, y = -2
  std::vector<double> a{4, 2, 0, 3}, x(2);
  ASSERT_TRUE(solveSymmetric(a, std::vector<double>{8, 8}, 2, x));
  EXPECT_NEAR(x[0], -1, 1e-14);
  EXPECT_NEAR(x[1], -2, 1e-14);
}

TEST(SolveSymmetric, RefusesAnIndefiniteMatrix) {
  std::vector<double> a{1, 2, 0, 1}, x(2);
  EXPECT_FALSE(solveSymmetric(a, std::vector<double>{1, 1}, 2, x));
}

/// minimise() with fresh buffers.
MinimiseResult minimised(Energy& energy, std::vector<Blob>& blobs, std::size_t active,
                         const MinimiseOptions& options, std::vector<double>* trace = nullptr) {
  MinimiseWorkspace workspace;
  return minimise(energy, blobs, active, options, workspace, trace);
}

TEST(LevenbergMarquardt, EveryStepLowersTheEnergy) {
  Energy energy({});
  energy.setPoints(tubePoints(4, 0.05));
  std::vector<Blob> blobs = rowOfBlobs(4, 4);
  std::vector<double> trace;
  const MinimiseResult result = minimised(energy, blobs, 0, {}, &trace);
  ASSERT_GT(trace.size(), 3U);
  for (std::size_t i = 1; i < trace.size(); ++i) EXPECT_LT(trace[i], trace[i - 1]);
  EXPECT_EQ(result.energy, trace.back());
  EXPECT_EQ(energy.evaluate(blobs), result.energy);
}

TEST(LevenbergMarquardt, OneBlobFindsASphere) {
  std::vector<Vec3d> points;
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Vec3d v{random.normal(), random.normal(), random.normal()};
    const double n = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    points.push_back({0.3 + v.x / n, v.y / n, v.z / n});
  }
  EnergyParameters p;
  p.curvatureWeight = 0;
  Energy energy(p);
  energy.setPoints(points);
  std::vector<Blob> blobs{{0, 0.2, 0, 0.3}};
  minimised(energy, blobs, 0, {100, 1e-12});
  EXPECT_NEAR(blobs[0].x, 0.3, 1e-6);
  EXPECT_NEAR(blobs[0].y, 0, 1e-6);
  EXPECT_NEAR(formats::isoRadius(p.kernel, p.kernelParameter, blobs[0].width, p.isoLevel), 1, 1e-6);
}

TEST(LevenbergMarquardt, ABlobLosesAtMostHalfOfItsWidthInAStep) {
  const std::vector<Vec3d> points = tubePoints(2, 0);
  Random random(7);
  std::size_t atBound = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Blob> blobs;
    for (int i = 0; i < 3; ++i)
      blobs.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                       random.uniform(0.1, 1.5)});
    const std::vector<Blob> before = blobs;
    Energy energy(normalised(points, blobs));
    energy.setPoints(points);
    minimised(energy, blobs, 0, {2, 1e-12});  // the energy is linearised at both ends of one step
    for (std::size_t i = 0; i < blobs.size(); ++i) {
      const double kept = blobs[i].width / before[i].width;
      EXPECT_GE(kept, 0.5 - 1e-12);
      if (kept < 0.5 + 1e-12) ++atBound;
    }
  }
  EXPECT_GT(atBound, 0U);
}

TEST(LevenbergMarquardt, FrozenBlobsStay) {
  Energy energy({});
  energy.setPoints(tubePoints(4, 0));
  std::vector<Blob> blobs = rowOfBlobs(3, 4);
  const Blob first = blobs[0], second = blobs[1], third = blobs[2];
  energy.freeze(blobs, 2);
  minimised(energy, blobs, 2, {});
  EXPECT_EQ(blobs[0].x, first.x);
  EXPECT_EQ(blobs[1].width, second.width);
  EXPECT_NE(blobs[2].width, third.width);
}

TEST(LevenbergMarquardt, CentresStayWithinReach) {
  Energy energy({});
  energy.setPoints(tubePoints(8, 0));
  std::vector<Blob> blobs{{-0.2, 0, 0, 0.35}, {0.2, 0, 0, 0.35}};
  MinimiseOptions options;
  options.reach = 1;
  minimised(energy, blobs, 0, options);
  for (const Blob& b : blobs) EXPECT_LE(b.x * b.x + b.y * b.y + b.z * b.z, 1 + 1e-12);
}

/// Points on the unit sphere around a place 2 along an axis (0: x, 1: y, 2: z), in its direction or
/// against it.
std::vector<Vec3d> sphereAlong(int axis, double sign) {
  std::vector<Vec3d> points;
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    std::array<double, 3> v{random.normal(), random.normal(), random.normal()};
    const double n = std::hypot(v[0], v[1], v[2]);
    for (double& c : v) c /= n;
    v[static_cast<std::size_t>(axis)] += 2 * sign;
    points.push_back({v[0], v[1], v[2]});
  }
  return points;
}

/// A blob that such points move along an axis, and its coordinate along that axis.
struct Moved {
  Blob blob;
  double along;
};

Moved movedAlong(int axis, double sign, const MinimiseOptions& options) {
  EnergyParameters p;
  p.curvatureWeight = 0;
  Energy energy(p);
  energy.setPoints(sphereAlong(axis, sign));
  std::vector<Blob> blobs{{0, 0, 0, 0.35}};
  minimised(energy, blobs, 0, options);
  const std::array<double, 3> centre{blobs[0].x, blobs[0].y, blobs[0].z};
  return {blobs[0], centre[static_cast<std::size_t>(axis)]};
}

TEST(LevenbergMarquardt, CentresStayWithinReachAlongEveryAxis) {
  MinimiseOptions options;
  options.maxIterations = 100;
  for (const int axis : {0, 1, 2})
    for (const double sign : {-1.0, 1.0}) {
      options.reach = 10;
      EXPECT_GT(std::abs(movedAlong(axis, sign, options).along), 1.5) << axis << " " << sign;
      options.reach = 0.5;
      const auto [blob, along] = movedAlong(axis, sign, options);
      EXPECT_LE(std::hypot(blob.x, blob.y, blob.z), 0.5 + 1e-12) << axis << " " << sign;
      EXPECT_GT(std::abs(along), 0.4) << axis << " " << sign;
    }
}

TEST(LevenbergMarquardt, CentresStayInABallAlongEveryAxis) {
  const std::vector<FitBall> balls{{{0, 0, 0}, 0.5}};
  MinimiseOptions options;
  options.maxIterations = 100;
  options.lumen = balls;
  for (const int axis : {0, 1, 2})
    for (const double sign : {-1.0, 1.0}) {
      const auto [blob, along] = movedAlong(axis, sign, options);
      EXPECT_LE(std::hypot(blob.x, blob.y, blob.z), 0.5 + 1e-12) << axis << " " << sign;
      EXPECT_GT(std::abs(along), 0.4) << axis << " " << sign;
    }
}

TEST(LevenbergMarquardt, CentresStayInTheUnionOfTheBalls) {
  const std::vector<Vec3d> points = tubePoints(8, 0);
  const std::vector<FitBall> balls{{{-0.2, 0, 0}, 0.1}, {{0.2, 0, 0}, 0.1}};
  const auto outside = [&](const Blob& b) {
    return std::none_of(balls.begin(), balls.end(), [&](const FitBall& ball) {
      return std::hypot(b.x - ball.centre.x, b.y, b.z) <= ball.radius + 1e-12;
    });
  };
  std::vector<Blob> free{{-0.2, 0, 0, 0.35}, {0.2, 0, 0, 0.35}}, kept = free;
  Energy energy(normalised(points, free));
  energy.setPoints(points);
  minimised(energy, free, 0, {});
  EXPECT_TRUE(std::any_of(free.begin(), free.end(), outside));
  MinimiseOptions options;
  options.lumen = balls;
  minimised(energy, kept, 0, options);
  EXPECT_TRUE(std::none_of(kept.begin(), kept.end(), outside));
}

TEST(LevenbergMarquardt, EndsAtNoHigherEnergyThanTheThesisConjugateGradients) {
  for (const double noise : {0.0, 0.05}) {
    for (const int count : {2, 3, 6}) {
      const std::vector<Vec3d> points = tubePoints(4, noise);
      std::vector<Blob> ours = rowOfBlobs(count, 4), theirs = ours;
      Energy energy(normalised(points, ours));
      energy.setPoints(points);
      const double reached = minimised(energy, ours, 0, {60, 1e-4}).energy;
      const double reference = test::minimiseByConjugateGradients(energy, theirs, 5, 12);
      EXPECT_LE(reached, 1.001 * reference) << count << " blobs, noise " << noise;
    }
  }
}

}  // namespace
}  // namespace lumen::convert::fitting
