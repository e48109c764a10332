// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Phantom make(const std::string& name, double noise, double bias, double psf) {
  PhantomOptions options;
  options.name = name;
  options.size = 96;
  options.noise = noise;
  options.bias = bias;
  options.psf = psf;
  Progress progress;
  return makePhantom(options, progress);
}

template <class Visit>
void forEachVoxel(const Phantom& phantom, Visit visit) {
  const int n = phantom.volume.geometry.size[0];
  std::size_t at = 0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        visit(phantom.volume.geometry.worldFromIndex(Vector3d(x, y, z)),
              static_cast<double>(voxelsOf(phantom)[at++]));
}

// Mean of the intensities at voxels whose signed distance, mm, lies in [low, high].
double meanAtDistance(const Phantom& phantom, double low, double high) {
  const TubeTreeDistance wall(phantom.truth.tree);
  double sum = 0, count = 0;
  forEachVoxel(phantom, [&](const Vector3d& point, double value) {
    const double distance = wall.nearest(point).distance;
    if (distance < low || distance > high) return;
    sum += value;
    count += 1;
  });
  return sum / count;
}

TEST(PhantomIntensity, IsFullWithinTheTubeAndBackgroundOutside) {
  const Phantom tube = make("tube", 0, 0, 0.6);
  EXPECT_DOUBLE_EQ(meanAtDistance(tube, -9, -0.5), kBackground + kContrast);
  EXPECT_DOUBLE_EQ(meanAtDistance(tube, 0.5, 99), kBackground);
}

TEST(PhantomIntensity, IsHalfwayAtTheWall) {
  // a straight wall blurs symmetrically; this one has a radius of 3.7 voxels, which costs some per
  // cent
  const Phantom tube = make("tube", 0, 0, 0.6);
  EXPECT_NEAR(meanAtDistance(tube, -0.01, 0.01), kBackground + 0.5 * kContrast, 0.05 * kContrast);
}

TEST(PhantomIntensity, SumsToTheVolumeOfTheVessel) {
  // a bent tube has the volume of a straight one (Pappus), and its round ends make one ball
  const Phantom helix = make("helix", 0, 0, 0);
  const double r = static_cast<double>(helix.truth.tree.radius[0]);
  const double length = static_cast<double>(helix.truth.tree.height[0]) *
                        static_cast<double>(helix.truth.tree.nodeCount() - 1);
  double sum = 0;
  forEachVoxel(helix,
               [&](const Vector3d&, double value) { sum += (value - kBackground) / kContrast; });
  const double expected = std::numbers::pi * r * r * (length + 4.0 / 3 * r);
  EXPECT_NEAR(sum * 0.2 * 0.2 * 0.2, expected, 0.003 * expected);
}

TEST(PhantomIntensity, BlurKeepsTheSum) {
  Progress progress;
  const Frame frame{0.2, 12.6};
  Image image = drawOccupancy(
      designHelix(frame), VolumeGeometry{{64, 64, 64}, Eigen::Vector3d::Constant(0.2)}, progress);
  const double sharp = std::accumulate(image.value.begin(), image.value.end(), 0.0);
  blur(image, Eigen::Vector3d::Constant(1.5), progress);
  EXPECT_NEAR(std::accumulate(image.value.begin(), image.value.end(), 0.0), sharp, 1e-5 * sharp);
}

TEST(PhantomIntensity, BlurSpreadsAnImpulseByItsSigma) {
  Image image{{21, 21, 21}, std::vector<float>(21 * 21 * 21, 0.0F)};
  image.row(10, 10)[10] = 1;
  Progress progress;
  blur(image, Eigen::Vector3d::Constant(1.5), progress);
  double sum = 0, square = 0;
  for (int z = 0; z < 21; ++z)
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 21; ++x) {
        sum += static_cast<double>(image.row(y, z)[x]);
        square += static_cast<double>(image.row(y, z)[x]) * (z - 10) * (z - 10);
      }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(square, 1.5 * 1.5, 0.01);
}

TEST(PhantomIntensity, DropsToAThirdTwiceInDropout) {
  const Phantom phantom = make("dropout", 0, 0, 0.6);
  const auto& tree = phantom.truth.tree;
  int drops = 0;
  bool low = false;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const Vector3d i = phantom.volume.geometry.indexFromWorld(toEigen(tree.centre[n]));
    const auto x = static_cast<std::size_t>(std::lround(i.x())),
               y = static_cast<std::size_t>(std::lround(i.y())),
               z = static_cast<std::size_t>(std::lround(i.z()));
    const double value = voxelsOf(phantom)[(z * 96 + y) * 96 + x];
    EXPECT_GE(value, 445);  // 100 + 350, but for rounding
    if (value < 455 && !low) ++drops;
    low = low ? value < 1000 : value < 455;
  }
  EXPECT_EQ(drops, 2);
}

TEST(PhantomIntensity, NoiseHasTheAskedDeviation) {
  const Phantom tube = make("tube", 0.05, 0, 0.6);
  double sum = 0, square = 0, count = 0;
  const TubeTreeDistance wall(tube.truth.tree);
  forEachVoxel(tube, [&](const Vector3d& point, double value) {
    if (point.x() > 2) return;  // the tube is further right
    sum += value;
    square += value * value;
    count += 1;
  });
  EXPECT_NEAR(sum / count, kBackground, 0.5);
  EXPECT_NEAR(std::sqrt(square / count - sum / count * (sum / count)), 50, 0.5);
}

TEST(PhantomIntensity, CountedNormalHasTheMomentsOfANormal) {
  Random random(3);
  const int n = 400000;
  double m1 = 0, m2 = 0, m4 = 0, above = 0;
  for (int i = 0; i < n; ++i) {
    const double x = countedNormal(random);
    m1 += x / n, m2 += x * x / n, m4 += x * x * x * x / n;
    above += x > 1.644854 ? 1.0 / n : 0.0;
  }
  // four standard errors of each
  EXPECT_NEAR(m1, 0, 0.0064);
  EXPECT_NEAR(m2, 1, 0.009);
  EXPECT_NEAR(m4, 3 - 0.0155, 0.062);
  EXPECT_NEAR(above, 0.05, 0.0014);
}

TEST(PhantomIntensity, BiasStaysWithinItsAmplitudeAndIsNotFlat) {
  const Phantom tube = make("tube", 0, 0.1, 0.6);
  double low = 1e9, high = -1e9;
  forEachVoxel(tube, [&](const Vector3d& point, double value) {
    if (point.x() > 2) return;
    low = std::min(low, value);
    high = std::max(high, value);
  });
  EXPECT_GE(low, kBackground - 100);
  EXPECT_LE(high, kBackground + 100);
  EXPECT_GT(high - low, 10);
}

TEST(PhantomIntensity, IsTheSameForAnyNumberOfThreads) {
  const Phantom many = make("kissing", 0.05, 0.1, 0.6);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(voxelsOf(many), voxelsOf(make("kissing", 0.05, 0.1, 0.6)));
}

TEST(PhantomIntensity, AnotherSeedGivesOtherNoise) {
  PhantomOptions options;
  options.name = "tube";
  options.size = 32;
  Progress progress;
  const Phantom first = makePhantom(options, progress);
  options.seed = 2;
  EXPECT_NE(voxelsOf(first), voxelsOf(makePhantom(options, progress)));
}

}  // namespace
}  // namespace lumen::convert
