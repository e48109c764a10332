// SPDX-License-Identifier: Apache-2.0
// Steps along a wall whose shape is known: a sphere about the origin, f = R - |X|.
#include "libblob/src/wall_step.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace lumen::blob {
namespace {

using field::Vec;

constexpr double kRadius = 2;
constexpr StepBounds kBounds{10, 1e-9};

Vec pointAt(double latitude) {
  return {kRadius * std::cos(latitude), 0, kRadius * std::sin(latitude)};
}

/// The wall at a foot on the sphere, seen from a query point.
WallShape sphereAt(const Vec& foot, const Vec& query) {
  const Vec n = (1 / kRadius) * foot;
  WallShape wall{query - foot, n, dot(query - foot, n), 1, {}};
  const double hessian[6] = {n.x * n.x - 1, n.y * n.y - 1, n.z * n.z - 1,
                             n.x * n.y,     n.x * n.z,     n.y * n.z};
  std::transform(hessian, hessian + 6, wall.hessian, [](double h) { return h / kRadius; });
  return wall;
}

double largestDifference(const double (&a)[6], const double (&b)[6]) {
  double most = 0;
  for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(WallStep, SolvesForTheNearestPointOfASphereToSecondOrder) {
  for (const double share : {0.6, 1.5})  // a query point in the sphere, and one outside
    for (const double away : {0.2, 0.1}) {
      const Vec query = share * pointAt(away), foot = pointAt(0);
      const WallShape wall = sphereAt(foot, query);
      const WallStep step = stepAlongWall(wall, kBounds);
      EXPECT_NEAR(step.sag, step.length * step.length / (2 * kRadius), 1e-12);
      const Vec there = foot + step.step - step.sag * wall.normal;
      EXPECT_LT(norm(there - pointAt(away)), kRadius * away * away * away);
      EXPECT_NEAR(norm(stepDownhill(wall, kBounds) - step.step), 0, 1e-12);
    }
}

TEST(WallStep, IsNoLongerThanHalfTheRadius) {
  const WallShape wall = sphereAt(pointAt(0), 1.5 * pointAt(1.2));
  EXPECT_NEAR(stepAlongWall(wall, {0.1, 1e-9}).length, 0.05, 1e-12);
  EXPECT_NEAR(norm(stepDownhill(wall, {0.1, 1e-9})), 0.05, 1e-12);
}

TEST(WallStep, LeavesAFarthestPoint) {
  // from beyond the centre the foot is the farthest point
  const WallShape wall = sphereAt(pointAt(0), -0.5 * pointAt(0));
  EXPECT_GT(norm(stepDownhill(wall, kBounds)), 0.01);
}

TEST(BendWall, ExplainsTheTurnOfTheNormalAlongTheMove) {
  const Vec query = 1.5 * pointAt(0.3);
  WallShape wall = sphereAt(pointAt(0), query);
  const Vec move = pointAt(0.2) - pointAt(0), turn = (1 / kRadius) * move;
  for (double& h : wall.hessian) h *= 0.5;  // a wall that is taken to be too flat
  bendWall(wall, move, turn);
  const Vec explained = multiply(wall.hessian, move);
  EXPECT_NEAR(norm(explained + wall.slope * turn), 0, 1e-12);
}

TEST(BendWall, LeavesAShapeThatExplainsItAndAWallWithoutAMove) {
  const WallShape sphere = sphereAt(pointAt(0), 1.5 * pointAt(0.3));
  WallShape wall = sphere;
  const Vec move{0, 0.1, 0.3};  // along the tangent plane
  bendWall(wall, move, (1 / kRadius) * move);
  EXPECT_NEAR(largestDifference(wall.hessian, sphere.hessian), 0, 1e-12);
  bendWall(wall, {0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(largestDifference(wall.hessian, sphere.hessian), 0, 1e-12);
}

TEST(BendWall, IsTheLeastChangeAcrossTheMoveToo) {
  const WallShape sphere = sphereAt(pointAt(0), 1.5 * pointAt(0.3));
  WallShape wall = sphere;
  bendWall(wall, {0, 0, 0.1}, {0, 0, 0.1});  // twice as curved along z
  const Vec across = multiply(wall.hessian, Vec{0, 1, 0});
  EXPECT_NEAR(norm(across - multiply(sphere.hessian, Vec{0, 1, 0})), 0, 1e-12);
}

}  // namespace
}  // namespace lumen::blob
