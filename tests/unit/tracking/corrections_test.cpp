// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/corrections.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <variant>

#include <gtest/gtest.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/track_case.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// How fast the blurred disc of a radius falls at a distance: the blurred edge, summed around it.
double fallOfDisc(double radius, double sigma, double distance) {
  double sum = 0;
  constexpr int kParts = 180;
  for (int i = 0; i < kParts; ++i) {
    const double c = std::cos(2 * std::numbers::pi * i / kParts);
    const double square = distance * distance + radius * radius - 2 * distance * radius * c;
    sum += c * std::exp(-square / (2 * sigma * sigma));
  }
  return sum * radius / (sigma * sigma * kParts);
}

double steepestPlace(double radius, double sigma) {
  double best = 0, strongest = 0;
  for (double r = 0.2 * radius; r < 2 * radius; r += 2e-4)
    if (const double fall = fallOfDisc(radius, sigma, r); fall > strongest) {
      strongest = fall;
      best = r;
    }
  return best;
}

TEST(PointSpread, TheRadiusOfABlurredDiscIsFoundFromWhereItFallsFastest) {
  for (const double radius : {1.0, 1.5, 3.0, 6.0})
    EXPECT_NEAR(cylinderRadius(steepestPlace(radius, 0.65), 0.65), radius, 2e-3) << radius;
  // s^2/(2R) for a wall that is nearly flat, twice that for a ball's
  EXPECT_NEAR(cylinderRadius(50.0, 1.0), 50.01, 1e-4);
  EXPECT_NEAR(ballRadius(50.0, 1.0), 50.02, 1e-4);
}

TEST(PointSpread, CorrectedRadiiGrowWithTheSeenOnesAndAreNeverBelowHalfOfThem) {
  double last = 0;
  for (double seen = 0.5; seen < 12; seen += 0.01) {
    const double radius = cylinderRadius(seen, 1.0);
    EXPECT_GE(radius, 0.5 * seen);
    EXPECT_GT(radius, last);
    last = radius;
  }
}

TEST(PointSpread, ZeroCorrectsNothing) {
  EXPECT_EQ(cylinderRadius(1.25, 0.0), 1.25);
  EXPECT_EQ(ballRadius(1.25, 0.0), 1.25);
}

// askew to the grid, so that its walls pass between voxels in every way
const Vector3d kCentre(4.71, 4.66, 4.8), kAxis = Vector3d(0.35, 0.25, 1).normalized();

double distanceToAxis(const Vector3d& point) {
  return (point - kCentre).cross(kAxis).norm();
}

/// A tube of `radius` blurred by `sigma` across its axis (mm); its values come from their fall.
Volume blurredTube(double radius, double sigma) {
  constexpr double kStep = 0.002, kFarthest = 8.5;
  std::vector<double> profile{0.0};
  for (double r = kFarthest; r > 0; r -= kStep)
    profile.push_back(profile.back() + kStep * fallOfDisc(radius, sigma, r - 0.5 * kStep));
  Volume volume = drawVolume(48, 0.2, [](const Vector3d&) { return 1.0; });
  auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto part = [&](std::size_t n) { return 0.2 * static_cast<double>(n % 48); };
    const double distance = distanceToAxis({part(i), part(i / 48), part(i / 48 / 48)});
    const auto at = static_cast<std::size_t>((kFarthest - distance) / kStep);
    voxels[i] = static_cast<std::int16_t>(std::lround(10000 * profile[at]));
  }
  return volume;
}

TrackResult trackTube(const Volume& volume, std::optional<double> pointSpread, double step = 0.5) {
  SeedBranch seed;
  seed.label = "tube";
  seed.points.push_back({kCentre, {}});
  TrackOptions options;
  options.pointSpread = pointSpread;
  options.step = step;
  Progress silent;
  return trackFromSeeds(volume, {seed}, options, silent);
}

double storedSpread(const TrackResult& tracked) {
  return std::get<double>(tracked.result.metadata.steps.back().parameters.at("point-spread"));
}

TEST(PointSpread, IsMeasuredInAVolumeAndStoredWithTheCase) {
  for (const double sigma : {0.16, 0.2, 0.24})
    EXPECT_NEAR(storedSpread(trackTube(blurredTube(0.8, sigma), {})), sigma, 0.05 * sigma);
}

// Where the blur is wide in voxels, only the wall's own bend makes its fall wider than the blur: by
// 2.3 percent at a radius of 3.3 standard deviations.
TEST(PointSpread, IsCorrectedForTheBendOfTheWall) {
  constexpr double kSigma = 0.3, kShortSteps = 0.2;
  const TrackResult tracked = trackTube(blurredTube(1.0, kSigma), {}, kShortSteps);
  EXPECT_NEAR(storedSpread(tracked), kSigma, 0.005 * kSigma);
}

/// Signed distance to the wall of a tube with elliptic sections, positive outside.
double distanceToEllipse(const Vector3d& point, double a, double b) {
  const Vector3d u = kAxis.unitOrthogonal(), v = kAxis.cross(u);
  const double x = (point - kCentre).dot(u), y = (point - kCentre).dot(v);
  double nearest = 1e9;
  constexpr int kParts = 720;
  for (int i = 0; i < kParts; ++i) {
    const double turn = 2 * std::numbers::pi * i / kParts;
    nearest = std::min(nearest, std::hypot(x - a * std::cos(turn), y - b * std::sin(turn)));
  }
  return std::hypot(x / a, y / b) < 1 ? -nearest : nearest;
}

// Lined up by a circle, the wall of an ellipse would seem blurred by its own axes' difference, and
// all walls of the volume would be moved outward.
TEST(PointSpread, OfVesselsThatAreNotRoundIsThatOfRoundOnes) {
  constexpr double kLong = 1.5, kShort = 1.0;
  const Volume oblong =
      drawVolume(48, 0.2, [](const Vector3d& p) { return distanceToEllipse(p, kLong, kShort); });
  const Volume round = drawVolume(
      48, 0.2, [](const Vector3d& p) { return distanceToAxis(p) - std::sqrt(kLong * kShort); });
  const TrackResult tracked = trackTube(oblong, {});
  EXPECT_NEAR(storedSpread(tracked), storedSpread(trackTube(round, {})), 0.02);
  std::vector<double> distances;
  for (const formats::Vec3f& p : tracked.result.points->position)
    distances.push_back(distanceToEllipse(toEigen(p), kLong, kShort));
  EXPECT_NEAR(median(std::move(distances)), 0, 0.01);
}

TEST(PointSpread, RadiiAndWallPointsOfANarrowBlurredTubeAreThoseOfTheTube) {
  const Volume volume = blurredTube(0.3, 0.14);  // 1.5 voxels wide, blurred by 0.7
  const TrackResult seen = trackTube(volume, 0.0), corrected = trackTube(volume, {});
  EXPECT_EQ(storedSpread(seen), 0.0);
  ASSERT_GT(corrected.result.tree.nodeCount(), 10u);
  const auto meanOf = [](const std::vector<float>& radii) {
    return std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
  };
  EXPECT_NEAR(meanOf(seen.result.tree.radius), 0.3 - 0.14 * 0.14 / 0.6, 0.006);
  EXPECT_NEAR(meanOf(corrected.result.tree.radius), 0.3, 0.006);
  std::vector<float> distances;
  for (const formats::Vec3f& p : corrected.result.points->position)
    distances.push_back(static_cast<float>(distanceToAxis(Vector3d(p.x, p.y, p.z))));
  EXPECT_NEAR(meanOf(distances), 0.3, 0.006);
}

// The lumen darkens over half a millimetre towards its wall and the background does not: the steepest place
// lies outside of the level halfway between them.
TEST(PointSpread, AWallWhoseLumenDarkensTowardsItLiesAtTheHalfLevel) {
  constexpr double kRadius = 2.0, kShoulder = 0.5, kEdge = 0.12;
  const auto level = [](double r) {
    const double into = kRadius - r;
    return 260 * (1 + std::erf(into / (std::numbers::sqrt2 * kEdge))) +
           480 * std::clamp(into / kShoulder, 0.0, 1.0);
  };
  Volume volume = drawVolume(48, 0.2, [](const Vector3d&) { return 1.0; });
  auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto part = [&](std::size_t n) { return 0.2 * static_cast<double>(n % 48); };
    voxels[i] = static_cast<std::int16_t>(
        std::lround(10 * level(distanceToAxis({part(i), part(i / 48), part(i / 48 / 48)}))));
  }
  double half = 0;
  while (level(half) > 500) half += 1e-4;
  const TrackResult seen = trackTube(volume, 0.0), corrected = trackTube(volume, {});
  const auto medianRadius = [](const TrackResult& tracked) {
    std::vector<float> radii = tracked.result.tree.radius;
    std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
    return static_cast<double>(radii[radii.size() / 2]);
  };
  const double blur = storedSpread(corrected);  // moves the wall outward
  EXPECT_GT(medianRadius(seen), half + 0.03);
  EXPECT_NEAR(medianRadius(corrected), half + blur * blur / (2 * half), 0.03);
}

}  // namespace
}  // namespace lumen::convert
