// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/section_fit.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace lumen::convert::fitting {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kBlur = 0.66, kContrast = 1000, kBackground = 100;

/// The voxels around a disc whose centre lies at `centre`, with noise in contrasts.
std::vector<SectionVoxel> voxelsOf(double radius, const Vector2d& centre, double noise,
                                   std::mt19937& random) {
  Outline disc;
  disc.radius = radius;
  disc.centre = centre;
  const BlurredSection image(disc, Matrix2d::Identity() * kBlur * kBlur);
  std::normal_distribution<double> normal;
  std::vector<SectionVoxel> voxels;
  for (int z = -2; z <= 2; ++z)
    for (int x = -8; x <= 8; ++x)
      for (int y = -8; y <= 8; ++y) {
        const Vector2d place(x + 0.3 * z, y + 0.2 * z);
        if (place.norm() > radius + 3) continue;
        const double share = image.at(place, z).share;
        voxels.push_back(
            {place, double(z), kBackground + kContrast * (share + noise * normal(random)), 0, 1});
      }
  return voxels;
}

SectionPrior priorOf(double radius, double contrastDeviation) {
  SectionPrior prior;
  prior.outline.radius = radius;
  prior.bend.setZero();
  prior.contrast = {kContrast, contrastDeviation};
  prior.covariance = Matrix2d::Identity() * kBlur * kBlur;
  return prior;
}

TEST(SectionFit, FindsAVesselThatIsNarrowerThanTheBlur) {
  std::mt19937 random(1);
  for (const double radius : {0.6, 1.0, 2.5}) {
    const Vector2d centre(0.2, -0.3);
    const SectionFit fit =
        fitSection(voxelsOf(radius, centre, 0, random), priorOf(1.3 * radius, 0.05 * kContrast));
    ASSERT_TRUE(fit.isValid);
    EXPECT_NEAR(fit.outline.radius, radius, 0.005);
    EXPECT_NEAR((fit.outline.centre - centre).norm(), 0, 0.01);
    EXPECT_NEAR(fit.background, kBackground, 1);
    EXPECT_NEAR(fit.contrast.value, kContrast, 5);
  }
}

TEST(SectionFit, ConfoundsRadiusAndContrastOfANarrowVesselWhoseContrastIsUnknown) {
  std::mt19937 random(2);
  const auto voxels = voxelsOf(0.4, Vector2d::Zero(), 0.02, random);
  const double known = fitSection(voxels, priorOf(0.4, 0.01 * kContrast)).radius.deviation;
  const double unknown = fitSection(voxels, priorOf(0.4, 0.5 * kContrast)).radius.deviation;
  EXPECT_GT(unknown, 3 * known);
}

TEST(SectionFit, FindsTheBlur) {
  std::mt19937 random(3);
  SectionPrior prior = priorOf(4, 0.5 * kContrast);
  prior.covariance *= 0.7 * 0.7;
  prior.fitsBlur = true;
  const SectionFit fit = fitSection(voxelsOf(4, Vector2d::Zero(), 0, random), prior);
  ASSERT_TRUE(fit.isValid);
  EXPECT_NEAR(fit.blur * 0.7, 1, 0.01);
}

TEST(SectionFit, StatesIntervalsThatHoldTheRadius) {
  std::mt19937 random(4);
  constexpr int kTrials = 100;
  for (const double radius : {0.8, 2.0}) {
    int held = 0;
    for (int i = 0; i < kTrials; ++i) {
      const SectionFit fit = fitSection(voxelsOf(radius, Vector2d::Zero(), 0.05, random),
                                        priorOf(radius, 0.02 * kContrast));
      ASSERT_TRUE(fit.isValid);
      held += std::abs(fit.radius.value - radius) < 1.96 * fit.radius.deviation ? 1 : 0;
    }
    EXPECT_GE(held, 90) << radius;  // of 100; 95 are expected, with a deviation of 2.2
  }
}

TEST(SectionFit, IgnoresABrightSpotBeside) {
  std::mt19937 random(5);
  auto voxels = voxelsOf(2, Vector2d::Zero(), 0.02, random);
  for (SectionVoxel& v : voxels)
    if ((v.place - Vector2d(4.5, 0)).norm() < 1) v.value += kContrast;
  const SectionFit fit = fitSection(voxels, priorOf(2.2, 0.05 * kContrast));
  ASSERT_TRUE(fit.isValid);
  EXPECT_NEAR(fit.outline.radius, 2, 0.06);
}

TEST(SectionFit, IsInvalidWithTooFewVoxels) {
  std::mt19937 random(6);
  auto voxels = voxelsOf(1, Vector2d::Zero(), 0, random);
  voxels.resize(12);
  EXPECT_FALSE(fitSection(voxels, priorOf(1, 50)).isValid);
}

}  // namespace
}  // namespace lumen::convert::fitting
