// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/geometry/exact_predicates.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// The hull is closed, and no point is outside of any of its planes.
void expectHullOf(const std::vector<Vector3d>& points, const std::vector<Triangle>& hull) {
  TriangleMesh mesh;
  mesh.position = points;
  mesh.triangle = hull;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides, turned;
  for (const Triangle& t : hull)
    for (std::size_t i = 0; i < 3; ++i) {
      sides.emplace_back(t[i], t[(i + 1) % 3]);
      turned.emplace_back(t[(i + 1) % 3], t[i]);
    }
  std::sort(sides.begin(), sides.end());
  std::sort(turned.begin(), turned.end());
  EXPECT_EQ(sides, turned);
  std::size_t outside = 0;
  for (const Triangle& t : hull)
    for (const Vector3d& p : points)
      if (orientation(points[t[0]], points[t[1]], points[t[2]], p) < 0) ++outside;
  EXPECT_EQ(outside, 0U);
}

double volumeOf(const std::vector<Vector3d>& points, const std::vector<Triangle>& hull) {
  TriangleMesh mesh;
  mesh.position = points;
  mesh.triangle = hull;
  return signedVolume(mesh);
}

TEST(ConvexHull, OfAGridIsItsCubeThoughMostPointsLieInTheFaces) {
  std::vector<Vector3d> points;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) points.push_back(0.1 * Vector3d(x, y, z));
  const std::vector<Triangle> hull = convexHull(points);
  expectHullOf(points, hull);
  EXPECT_NEAR(volumeOf(points, hull), 0.125, 1e-15);
}

TEST(ConvexHull, OfPointsOnABallHasAllOfThem) {
  std::vector<Vector3d> points;
  Random random(3, 0);
  for (int i = 0; i < 600; ++i) {
    const Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    points.push_back(p.normalized());
  }
  const std::vector<Triangle> hull = convexHull(points);
  expectHullOf(points, hull);
  EXPECT_EQ(hull.size(), 2 * points.size() - 4);  // Euler
}

TEST(ConvexHull, LeavesOutPointsInside) {
  std::vector<Vector3d> points;
  Random random(4, 0);
  for (int i = 0; i < 2000; ++i)
    points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  const std::vector<Triangle> hull = convexHull(points);
  expectHullOf(points, hull);
  EXPECT_GT(volumeOf(points, hull), 7);
  EXPECT_LT(volumeOf(points, hull), 8);
  EXPECT_LT(hull.size(), 400U);
}

TEST(ConvexHull, OfPointsInAPlaneIsEmpty) {
  std::vector<Vector3d> points;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y) points.emplace_back(x, y, x + y);
  EXPECT_TRUE(convexHull(points).empty());
  EXPECT_TRUE(convexHull({}).empty());
}

}  // namespace
}  // namespace lumen::convert
