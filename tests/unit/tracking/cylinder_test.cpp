// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/cylinder.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/tracking/cylinders/cylinder_equations.h"

namespace lumen::convert {
namespace {

struct Truth {
  Eigen::Vector3d centre, axis;
  double radius;
};

/// `count` points on a cylinder within one radius of its centre along the axis, with radial noise,
/// as seen from `origin`.
Candidates pointsOn(const Truth& truth, const Eigen::Vector3d& origin, int count, double noise) {
  Random random(7);
  const Eigen::Vector3d e1 = truth.axis.unitOrthogonal(), e2 = truth.axis.cross(e1);
  Candidates out;
  out.origin = origin;
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double r = truth.radius + noise * random.normal();
    const Eigen::Vector3f p = (truth.centre + r * (std::cos(angle) * e1 + std::sin(angle) * e2) +
                               random.uniform(-1, 1) * truth.radius * truth.axis - origin)
                                  .cast<float>();
    out.x.push_back(p.x());
    out.y.push_back(p.y());
    out.z.push_back(p.z());
    out.strength.push_back(1);
  }
  return out;
}

double distanceToAxis(const Truth& truth, const Eigen::Vector3d& point) {
  return (point - truth.centre).cross(truth.axis).norm();
}

/// Result of the search with default options.
Cylinder search(const Candidates& points, const ExpectedCylinder& expected, Random& random) {
  CylinderWorkspace workspace;
  return estimateCylinder(CylinderSearch(TrackOptions{}), points, expected, random, workspace);
}

const Truth kTruth{{10, 20, 30}, Eigen::Vector3d(1, 2, 3).normalized(), 2.0};

TEST(Cylinder, IsFoundExactlyFromCleanPoints) {
  const Candidates points = pointsOn(kTruth, {10.3, 20.2, 30}, 120, 0);
  Random random(1);
  const Cylinder found =
      search(points, {Eigen::Vector3d(1, 2, 2.5).normalized(), 2.4, false}, random);
  EXPECT_NEAR(found.radius, 2.0, 1e-4);
  EXPECT_NEAR(std::abs(found.axis.dot(kTruth.axis)), 1.0, 1e-7);
  EXPECT_NEAR(distanceToAxis(kTruth, found.centre), 0.0, 1e-4);
  EXPECT_DOUBLE_EQ(found.inlierRate, 1.0);
}

TEST(Cylinder, IsFoundAmongFortyPercentOutliers) {
  Candidates points = pointsOn(kTruth, kTruth.centre, 120, 0.03);
  Random random(2);
  for (int i = 0; i < 80; ++i) {
    points.x.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.y.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.z.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.strength.push_back(1);
  }
  const Cylinder found = search(points, {kTruth.axis, 2.0, false}, random);
  EXPECT_NEAR(found.radius, 2.0, 0.05);
  EXPECT_LT(distanceToAxis(kTruth, found.centre), 0.1);
  EXPECT_GT(found.inlierRate, 0.55);
}

TEST(Cylinder, OutsideOfHalfToThreeHalvesOfTheGuessIsNotValid) {
  const Candidates points = pointsOn(kTruth, kTruth.centre, 120, 0);
  Random random(3);
  const Cylinder found = search(points, {kTruth.axis, 0.9, false}, random);
  EXPECT_LT(found.inlierRate, 0.35);
}

TEST(Cylinder, OfASmoothCourseIsPreferredToASharpTurnThatFitsAsWell) {
  // two equal tubes through the origin: along z, and along x
  const Truth upright{{0, 0, 0}, Eigen::Vector3d::UnitZ(), 1.0};
  const Truth lying{{0, 0, 0}, Eigen::Vector3d::UnitX(), 1.0};
  Candidates points = pointsOn(upright, {0, 0, 0}, 100, 0.02);
  const Candidates others = pointsOn(lying, {0, 0, 0}, 104, 0.02);
  points.x.insert(points.x.end(), others.x.begin(), others.x.end());
  points.y.insert(points.y.end(), others.y.begin(), others.y.end());
  points.z.insert(points.z.end(), others.z.begin(), others.z.end());
  points.strength.resize(204, 1);
  Random random(5);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.2, 0, 1).normalized();
  EXPECT_GT(search(points, {direction, 1.0, true}, random).axis.z(), 0.95);
}

TEST(Cylinder, ThatDoesNotHoldTheOriginOfTheRaysIsNotValid) {
  const Eigen::Vector3d outside = kTruth.centre + 2.5 * kTruth.axis.unitOrthogonal();
  const Candidates points = pointsOn(kTruth, outside, 120, 0);
  Random random(4);
  EXPECT_LT(search(points, {kTruth.axis, 2.0, false}, random).inlierRate, 0.7);
}

/// Result of least squares with default options.
Cylinder near(const Candidates& points, const ExpectedCylinder& expected) {
  CylinderWorkspace workspace;
  return nearCylinder(CylinderSearch(TrackOptions{}), points, expected, workspace);
}

TEST(NearCylinder, IsFoundFromAWrongPlaceDirectionAndRadiusAmongOutliers) {
  const Eigen::Vector3d aside = kTruth.axis.unitOrthogonal();
  Candidates points = pointsOn(kTruth, kTruth.centre + 0.6 * aside, 120, 0.03);
  Random random(2);
  for (int i = 0; i < 60; ++i) {
    points.x.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.y.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.z.push_back(static_cast<float>(random.uniform(-5, 5)));
    points.strength.push_back(1);
  }
  const Eigen::Vector3d turned = (kTruth.axis + 0.35 * aside).normalized();
  for (const double radius : {1.3, 2.0, 2.6}) {
    const Cylinder found = near(points, {turned, radius, true});
    EXPECT_NEAR(found.radius, 2.0, 0.05) << radius;
    EXPECT_LT(distanceToAxis(kTruth, found.centre), 0.1) << radius;
    EXPECT_GT(std::abs(found.axis.dot(kTruth.axis)), 0.995) << radius;
    EXPECT_GT(found.inlierRate, 0.6) << radius;
  }
}

TEST(NearCylinder, MovesAsLittleAsItsCandidates) {
  Candidates points = pointsOn(kTruth, kTruth.centre, 120, 0.1);
  const ExpectedCylinder expected{kTruth.axis, 1.7, true};
  const Cylinder before = near(points, expected);
  for (float& x : points.x) x += 1e-5F;
  const Cylinder after = near(points, expected);
  EXPECT_NEAR(after.radius, before.radius, 1e-3);
  EXPECT_LT((after.centre - before.centre).norm(), 1e-3);
}

TEST(NearCylinder, IsNoneWhereTheWallIsFarFromTheExpectedOne) {
  const Candidates points = pointsOn(kTruth, kTruth.centre, 120, 0);
  EXPECT_EQ(near(points, {kTruth.axis, 0.9, true}).inlierRate, 0);
  const Eigen::Vector3d outside = kTruth.centre + 2.5 * kTruth.axis.unitOrthogonal();
  EXPECT_LT(near(pointsOn(kTruth, outside, 120, 0), {kTruth.axis, 2.0, true}).inlierRate, 0.35);
}

TEST(Cylinder, RefinementMovesTheCentreToTheMedianOfTheInliersAlongTheAxis) {
  Candidates points;
  for (const float z : {0.0F, 1.0F, 2.0F, 3.0F, 10.0F})
    for (int k = 0; k < 8; ++k) {
      points.x.push_back(static_cast<float>(std::cos(k * std::numbers::pi / 4)));
      points.y.push_back(static_cast<float>(std::sin(k * std::numbers::pi / 4)));
      points.z.push_back(z);
      points.strength.push_back(1);
    }
  CylinderWorkspace workspace;
  const Cylinder found = refineCylinder(
      points, {Eigen::Vector3d(0, 0, 9), Eigen::Vector3d::UnitZ(), 1.05, 0}, 0.1, workspace);
  EXPECT_NEAR(found.centre.z(), 2.0, 1e-6);
  EXPECT_NEAR(found.radius, 1.0, 1e-6);
}

TEST(Circles, PassThroughTheirThreePoints) {
  Random random(6);
  std::vector<float> u, v;
  for (int i = 0; i < 40; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    u.push_back(static_cast<float>(0.3 + 1.5 * std::cos(angle)));
    v.push_back(static_cast<float>(-0.2 + 1.5 * std::sin(angle)));
  }
  CircleBlock block;
  drawTriples(u, v, random, block);
  circlesThrough(block, 1.0F, 2.0F);
  int valid = 0;
  for (std::size_t t = 0; t < kCircleBlock; ++t) {
    if (block.squaredRadius[t] == 0) continue;
    ++valid;
    EXPECT_NEAR(block.u[t], 0.3, 1e-2);
    EXPECT_NEAR(block.v[t], -0.2, 1e-2);
    EXPECT_NEAR(block.squaredRadius[t], 2.25, 3e-2);
  }
  EXPECT_GT(valid, 20);
}

TEST(Circles, OutsideOfTheRadiiOrWithoutTheOriginAreNotValid) {
  CircleBlock block{};
  // (2, 0), (4, 0), (3, 1): centre (3, 0), radius 1, does not hold the origin
  block.u[0] = 2;
  block.au[0] = 2;
  block.bu[0] = 1;
  block.bv[0] = 1;
  // (-1, 0), (1, 0), (0, 1): centre (0, 0), radius 1
  block.u[1] = -1;
  block.au[1] = 2;
  block.bu[1] = 1;
  block.bv[1] = 1;
  CircleBlock narrow = block;
  circlesThrough(block, 0.5F, 1.5F);
  EXPECT_EQ(block.squaredRadius[0], 0.0F);
  EXPECT_EQ(block.squaredRadius[1], 1.0F);
  circlesThrough(narrow, 1.1F, 1.5F);
  EXPECT_EQ(narrow.squaredRadius[1], 0.0F);
}

TEST(CountInBand, AgreesWithItsReference) {
  Random random(5);
  std::vector<float> u, v;
  for (int i = 0; i < 163; ++i) {
    u.push_back(static_cast<float>(random.uniform(-2, 2)));
    v.push_back(static_cast<float>(random.uniform(-2, 2)));
  }
  for (std::size_t count = 0; count <= u.size(); ++count)
    EXPECT_EQ(countInBand(u.data(), v.data(), count, 0.1F, -0.2F, 0.81F, 1.21F),
              countInBandReference(u.data(), v.data(), count, 0.1F, -0.2F, 0.81F, 1.21F));
}

using Eigen::Vector3d;

const Cylinder kCylinder{{3, -2, 5}, Vector3d(1, 2, -2).normalized(), 2, 0};

/// Points around the cylinder, some far off; the one of index 5 on its axis.
Candidates scattered(std::size_t count) {
  Random random(11);
  Candidates out;
  out.origin = {3.4, -2.2, 4.9};
  for (std::size_t i = 0; i < count; ++i) {
    Vector3d at(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
    if (i == 5) {
      out.origin = kCylinder.centre;
      at.setZero();
    }
    out.x.push_back(static_cast<float>(at.x()));
    out.y.push_back(static_cast<float>(at.y()));
    out.z.push_back(static_cast<float>(at.z()));
    out.strength.push_back(1);
  }
  return out;
}

/// The equations by their definition, of points with a weight that hangs on the residual.
CylinderEquations byDefinition(const Candidates& points, const CylinderEquations& basis,
                               const std::function<double(double)>& weightOf) {
  CylinderEquations out;
  out.normal.setZero();
  out.right.setZero();
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Vector3d p = points.origin + points.offset(i) - kCylinder.centre;
    const double u = p.dot(basis.e1), v = p.dot(basis.e2), w = p.dot(kCylinder.axis);
    const double distance = std::hypot(u, v), residual = distance - kCylinder.radius;
    if (distance == 0) continue;
    const double weight = weightOf(residual);
    Eigen::Matrix<double, 5, 1> row;
    row << -u / distance, -v / distance, -w * u / distance, -w * v / distance, -1.0;
    out.normal += weight * row * row.transpose();
    out.right -= weight * residual * row;
    out.weights += weight;
  }
  return out;
}

void expectSame(const CylinderEquations& a, const CylinderEquations& b) {
  const double scale = 1e-12 * (1 + b.normal.cwiseAbs().maxCoeff());
  EXPECT_LT((a.normal - b.normal).cwiseAbs().maxCoeff(), scale);
  EXPECT_LT((a.right - b.right).cwiseAbs().maxCoeff(), scale);
  EXPECT_NEAR(a.weights, b.weights, scale);
}

TEST(CylinderEquations, CountPointsTheLessTheFartherTheyAreFromTheWall) {
  constexpr double kReach = 0.7;
  const auto tukey = [](double residual) {
    const double share = residual / kReach;
    return std::abs(share) < 1 ? std::pow(1 - share * share, 2) : 0.0;
  };
  for (const std::size_t count : {0U, 1U, 5U, 63U, 64U, 65U, 130U, 162U, 642U}) {
    const Candidates points = scattered(count);
    const CylinderEquations found = robustEquations(points, kReach, kCylinder);
    expectSame(found, byDefinition(points, found, tukey));
    if (count > 100) {
      EXPECT_GT(found.weights, 10);
      EXPECT_LT(found.weights, 0.5 * static_cast<double>(count));
    }
  }
}

TEST(CylinderEquations, SolveToTheStepThatTheyWereMadeOf) {
  CylinderEquations equations = robustEquations(scattered(162), 3, kCylinder);
  Eigen::Matrix<double, 5, 1> step;
  step << 0.1, -0.2, 0.05, 0.02, 0.3;
  equations.right = equations.normal * step;
  const auto solved = equations.solve();
  ASSERT_TRUE(solved);
  EXPECT_LT((*solved - step).norm(), 1e-6);
}

}  // namespace
}  // namespace lumen::convert
