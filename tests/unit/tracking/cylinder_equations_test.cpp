// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinder_equations.h"

#include <cmath>
#include <cstddef>
#include <functional>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen::convert {
namespace {

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
