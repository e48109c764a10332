// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/geometry/convex_hull.h"
#include "converters/geometry/exact_predicates.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {
namespace {

struct Boxes {
  std::vector<Box3d> box;
  std::vector<Eigen::Vector3d> middle;
};

Boxes randomBoxes(std::size_t count) {
  Random random(7, count);
  Boxes boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.middle.emplace_back(random.uniform(), random.uniform(), random.uniform());
    boxes.box.emplace_back().add(boxes.middle.back(), 0.1 * random.uniform());
  }
  return boxes;
}

void expectSound(const BoxTree<double>& tree, const std::vector<Box3d>& boxes) {
  std::vector<std::uint32_t> items = tree.items(), all(boxes.size());
  std::sort(items.begin(), items.end());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(items, all);
  std::size_t held = 0;
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const BoxTree<double>::Node& node = tree.node(i);
    Box3d around;
    if (node.count == 0) {
      EXPECT_GT(node.at, i + 1);
      around = tree.node(i + 1).box;
      around.add(tree.node(node.at).box);
    }
    for (std::uint32_t k = node.at; k < node.at + node.count; ++k)
      around.add(boxes[tree.items()[k]]);
    EXPECT_EQ(node.box, around) << i;
    EXPECT_LE(node.count, BoxTree<double>::kLeafItems);
    held += node.count;
  }
  EXPECT_EQ(held, boxes.size());
}

TEST(BoxTree, HoldsEveryItemOnceInBoxesThatFit) {
  for (const std::size_t count : {1U, 4U, 5U, 8U, 9U, 100U, 1025U}) {
    const Boxes boxes = randomBoxes(count);
    expectSound(BoxTree<double>(boxes.box), boxes.box);
    expectSound(BoxTree<double>(boxes.box, boxes.middle), boxes.box);
  }
}

TEST(BoxTree, KeepsTheOrderOfItemsThatAreNeighboursAndFillsLeaves) {
  const BoxTree<double> tree(randomBoxes(1025).box);
  EXPECT_TRUE(std::is_sorted(tree.items().begin(), tree.items().end()));
  std::size_t leaves = 0;
  for (const auto& node : tree.nodes()) leaves += node.count > 0 ? 1 : 0;
  EXPECT_EQ(leaves, 257U);  // 256 of four items, and one
}

TEST(BoxTree, OfNothingHasNoNodes) {
  EXPECT_TRUE(BoxTree<float>(std::vector<Box3f>{}).nodes().empty());
}

TEST(Box, IsEmptyUntilAPointIsAdded) {
  Box3d box;
  EXPECT_TRUE(box.isEmpty());
  box.add(Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(box.isEmpty());
  EXPECT_TRUE(box.contains({1, 2, 3}));
}

TEST(Box, MeetsOneThatSharesAFace) {
  Box3d one, other;
  one.add(Eigen::Vector3d(0, 0, 0), 1.0);
  other.add(Eigen::Vector3d(2, 0, 0), 1.0);
  EXPECT_TRUE(one.meets(other));
  other.low.x() += 1e-12;
  EXPECT_FALSE(one.meets(other));
}

TEST(Box, GapIsWhatPointAndBoxAreApart) {
  Box3d box;
  box.add(Eigen::Vector3d(0, 0, 0), 1.0);
  EXPECT_EQ(box.gap({4, 0.5, -3}), Eigen::Vector3d(3, 0, 2));
}

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
