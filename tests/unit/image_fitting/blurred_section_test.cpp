// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/blurred_section.h"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace lumen::convert::fitting {
namespace {

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

}  // namespace
}  // namespace lumen::convert::fitting
