// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/section_fit.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "converters/stages/fitting/image/blurred_section.h"

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

using Eigen::Matrix2d;
using Eigen::Vector2d;

Outline lopsided() {
  Outline o;
  o.radius = 3;
  o.harmonics = 4;
  o.cosine = {0.3, 0.1, 0.05};
  o.sine = {-0.2, 0.1, 0};
  o.centre = {0.2, -0.1};
  o.tilt = {0.1, 0.2};
  o.bend = {0.02, 0.01};
  o.taper = 0.1;
  o.flare = 0.02;
  return o;
}

Matrix2d slanted() {
  Matrix2d covariance;
  covariance << 0.5, 0.1, 0.1, 0.3;
  return covariance;
}

TEST(BlurredSection, IsTheClosedFormInTheMiddleOfADisc) {
  const double s = 0.66;
  for (const double radius : {0.3, 0.6, 1.0, 2.0}) {
    Outline disc;
    disc.radius = radius;
    const BlurredSection image(disc, Matrix2d::Identity() * s * s);
    EXPECT_NEAR(image.at(Vector2d::Zero(), 0).share, 1 - std::exp(-radius * radius / (2 * s * s)),
                1e-6);
  }
}

TEST(BlurredSection, IsTheErrorFunctionAcrossAWideWall) {
  Outline disc;
  disc.radius = 500;
  const BlurredSection image(disc, Matrix2d::Identity());
  // a disc that is this wide is a half plane; it has 192 corners, so the wall is looked at from near
  Outline less;
  less.radius = 30;
  const BlurredSection nearly(less, Matrix2d::Identity());
  EXPECT_NEAR(nearly.at({30, 0}, 0).share, 0.5 - 1 / (30 * 2 * std::sqrt(2 * std::numbers::pi)),
              1e-3);
  EXPECT_NEAR(image.at({0, 0}, 0).share, 1, 1e-12);
  EXPECT_NEAR(image.at({510, 0}, 0).share, 0, 1e-12);
}

TEST(BlurredSection, IsTheSumOfTheGaussianOverTheSection) {
  const Outline o = lopsided();
  const Matrix2d covariance = slanted(), inverse = covariance.inverse();
  const Vector2d place(2.6, 1.1);
  const double height = 0.7, step = 0.02;
  const double second = 0.5 * (height * height + 0.5 * covariance.trace());
  double sum = 0;
  for (double x = -5; x < 7; x += step)
    for (double y = -5; y < 7; y += step) {
      const Vector2d from = Vector2d(x, y) - o.centre - o.tilt * height - o.bend * second;
      const double wall =
          o.at(std::atan2(from.y(), from.x())) + o.taper * height + o.flare * second;
      if (from.norm() > wall) continue;
      const Vector2d e = Vector2d(x, y) - place;
      sum += std::exp(-0.5 * e.dot(inverse * e));
    }
  sum *= step * step / (2 * std::numbers::pi * std::sqrt(covariance.determinant()));
  EXPECT_NEAR(BlurredSection(o, covariance).at(place, height).share, sum, 5e-4);
}

TEST(BlurredSection, HasTheDerivativesOfItsDifferences) {
  const Outline o = lopsided();
  const Matrix2d covariance = slanted();
  const Vector2d place(2.6, 1.1);
  double derivative[kMostParameters];
  const auto value = BlurredSection(o, covariance).derivatives(place, 0.7, derivative);
  constexpr double kStep = 1e-4;
  for (int i = 0; i < parameterCount(o); ++i) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(parameterCount(o));
    step[i] = kStep;
    Outline more = o, less = o;
    addTo(more, step);
    addTo(less, -step);
    EXPECT_NEAR(derivative[i],
                (BlurredSection(more, covariance).at(place, 0.7).share -
                 BlurredSection(less, covariance).at(place, 0.7).share) /
                    (2 * kStep),
                1e-4)
        << i;
  }
  Outline even = o;  // the blur along the axis also moves taper's and bend's means
  even.bend.setZero();
  even.flare = 0;
  const double wider = BlurredSection(even, covariance).at(place, 0.7).wider;
  EXPECT_NEAR(wider,
              (BlurredSection(even, covariance * std::exp(2 * kStep)).at(place, 0.7).share -
               BlurredSection(even, covariance * std::exp(-2 * kStep)).at(place, 0.7).share) /
                  (2 * kStep),
              1e-4);
  EXPECT_NEAR(value.share, BlurredSection(o, covariance).at(place, 0.7).share, 1e-15);
}

TEST(Outline, HasTheAreaOfAnEllipseToSecondOrder) {
  Outline o;
  o.radius = 2;
  o.harmonics = 2;
  o.cosine[0] = 0.1;
  EXPECT_NEAR(o.area(), std::numbers::pi * (4 + 0.005), 1e-12);
  EXPECT_NEAR(o.at(0), 2.1, 1e-12);
  EXPECT_NEAR(o.at(std::numbers::pi / 2), 1.9, 1e-12);
}

/// A vessel of 20 nodes along x, 1 mm apart, with a branch of 20 more at its node 10.
formats::CenterlineTree forked() {
  formats::CenterlineTree tree;
  for (int i = 0; i < 20; ++i) {
    tree.centre.push_back({float(i), 0, 0});
    tree.parent.push_back(i - 1);
    tree.branch.push_back(0);
  }
  for (int i = 0; i < 20; ++i) {
    tree.centre.push_back({10, float(i + 1), 0});
    tree.parent.push_back(i == 0 ? 10 : 19 + i);
    tree.branch.push_back(1);
  }
  tree.branches.resize(2);
  tree.branches[0].label = "root";
  tree.branches[0].nodeCount = 20;
  tree.branches[1].label = "child";
  tree.branches[1].parentNode = 10;
  tree.branches[1].firstNode = tree.branches[1].nodeCount = 20;
  return tree;
}

TEST(ContrastAlong, GivesABranchTheContrastOfItsParent) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {800, 10};
  const auto expected = contrastAlong(tree, measured, 1);
  ASSERT_EQ(expected.size(), 40U);
  EXPECT_NEAR(expected[25].value, 800, 1);
  EXPECT_NEAR(expected[39].value, 800, 1);
  EXPECT_GT(expected[39].deviation, expected[25].deviation);
}

TEST(ContrastAlong, LeavesOutTheNodesOwnMeasurement) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {800, 10};
  measured[5] = {3000, 1};
  EXPECT_NEAR(contrastAlong(tree, measured, 1)[5].value, 800, 1);
}

TEST(ContrastAlong, FollowsAContrastThatFades) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {1000 - 25.0 * double(i), 10};
  const auto expected = contrastAlong(tree, measured, 1);
  EXPECT_NEAR(expected[8].value, 800, 10);
}

TEST(ContrastAlong, IsEmptyWithoutAMeasurement) {
  EXPECT_TRUE(contrastAlong(forked(), std::vector<Estimate>(40), 1).empty());
}

}  // namespace
}  // namespace lumen::convert::fitting
