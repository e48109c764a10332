// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/tube_tree_distance.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "converters/base/random.h"

namespace lumen {
namespace {

using Eigen::Vector3d;

// A winding branch of `count` nodes with changing radii, and a straight one that leaves it.
formats::CenterlineTree windingTree(int count) {
  formats::CenterlineTree tree;
  const auto node = [&](double x, double y, double z, double r, std::uint32_t branch) {
    tree.centre.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(static_cast<float>(r));
    tree.height.push_back(0.1F);
    tree.parent.push_back(static_cast<std::int32_t>(tree.parent.size()) - 1);
    tree.branch.push_back(branch);
  };
  for (int i = 0; i < count; ++i)
    node(0.2 * i, 2 * std::sin(0.2 * i), std::cos(0.15 * i), 1 + 0.3 * std::sin(0.4 * i), 0);
  for (int i = 0; i < 10; ++i) node(4, -0.5 * i, 1, 0.5, 1);
  tree.branches.push_back({"root",
                           formats::BranchKind::Vessel,
                           formats::kNoParent,
                           0,
                           static_cast<std::uint32_t>(count),
                           formats::StopReason::Unknown,
                           {}});
  tree.branches.push_back({"b01",
                           formats::BranchKind::Vessel,
                           5,
                           static_cast<std::uint32_t>(count),
                           10,
                           formats::StopReason::Unknown,
                           {}});
  tree.parent[static_cast<std::size_t>(count)] = 5;
  return tree;
}

Vector3d centreOf(const formats::CenterlineTree& tree, std::size_t n) {
  return {static_cast<double>(tree.centre[n].x), static_cast<double>(tree.centre[n].y),
          static_cast<double>(tree.centre[n].z)};
}

// The nearest of a thousand spheres that each segment sweeps.
double bruteForce(const formats::CenterlineTree& tree, const Vector3d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (const formats::Branch& b : tree.branches)
    for (std::size_t n = b.firstNode; n + 1 < b.firstNode + b.nodeCount; ++n)
      for (int k = 0; k <= 1000; ++k) {
        const double u = k / 1000.0;
        const Vector3d centre = (1 - u) * centreOf(tree, n) + u * centreOf(tree, n + 1);
        const double radius = (1 - u) * static_cast<double>(tree.radius[n]) +
                              u * static_cast<double>(tree.radius[n + 1]);
        best = std::min(best, (point - centre).norm() - radius);
      }
  return best;
}

Vector3d randomPoint(Random& random) {
  const double x = random.uniform(-2, 10), y = random.uniform(-5, 4);
  return {x, y, random.uniform(-4, 4)};
}

TEST(RoundCone, OfEqualRadiiIsACapsule) {
  const RoundCone capsule({0, 0, 0}, 1, {0, 0, 4}, 1);
  EXPECT_DOUBLE_EQ(capsule.distance({3, 0, 2}), 2);
  EXPECT_DOUBLE_EQ(capsule.distance({0, 0, 7}), 2);
  EXPECT_DOUBLE_EQ(capsule.distance({0, 0, 1}), -1);
  EXPECT_DOUBLE_EQ(capsule.distance({0, 3, -4}), 4);
}

TEST(RoundCone, MeasuresAlongTheNormalOfItsSlant) {
  // radii 2 and 1 over a length of 5/3: the normal has the sine 0.6 towards the narrow end
  const RoundCone cone({0, 0, 0}, 2, {0, 0, 5.0 / 3}, 1);
  const Vector3d normal(0.8, 0, 0.6);
  double along = 0;
  EXPECT_NEAR(cone.distance(Vector3d(0, 0, 1) + 3 * normal, &along), 3 - 1.4, 1e-12);
  EXPECT_NEAR(along, 0.6, 1e-12);
}

TEST(RoundCone, IsTheLargerSphereIfThatHoldsTheOther) {
  const RoundCone cone({0, 0, 0}, 0.5, {1, 0, 0}, 2);
  double along = 0;
  EXPECT_DOUBLE_EQ(cone.distance({-3, 0, 0}, &along), 2);
  EXPECT_DOUBLE_EQ(along, 1);
}

TEST(TubeTreeDistance, EqualsBruteForceOverSweptSpheres) {
  const formats::CenterlineTree tree = windingTree(40);
  const TubeTreeDistance wall(tree);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Vector3d point = randomPoint(random);
    // the spheres are 0.0006 mm apart at most, so brute force is above by a little at most
    const double expected = bruteForce(tree, point);
    EXPECT_LE(wall.nearest(point).distance, expected + 1e-6);
    EXPECT_GE(wall.nearest(point).distance, expected - 1e-4);
  }
}

TEST(TubeTreeDistance, CollectedSegmentsGiveTheSameAnswerNearTheirCentre) {
  const TubeTreeDistance wall(windingTree(40));
  Random random(2);
  std::vector<std::uint32_t> segments;
  for (int i = 0; i < 200; ++i) {
    const Vector3d centre = randomPoint(random);
    wall.collect(centre, 0.3, segments);
    const Vector3d point = centre + 0.17 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1),
                                                    random.uniform(-1, 1));
    const WallHit one = wall.nearest(point), other = wall.nearestAmong(segments, point);
    EXPECT_EQ(one.distance, other.distance);
    EXPECT_EQ(one.node, other.node);
  }
}

TEST(TubeTreeDistance, NamesTheNearestBranchAndSegment) {
  const TubeTreeDistance wall(windingTree(40));
  const WallHit hit = wall.nearest({4.2, -4.25, 1});
  EXPECT_EQ(hit.branch, 1U);
  EXPECT_EQ(hit.node, 48U);
  EXPECT_NEAR(hit.along, 0.5, 1e-6);
  EXPECT_NEAR(hit.distance, -0.3, 1e-6);
}

TEST(TubeTreeDistance, OfOneBranchIgnoresTheOthers) {
  const TubeTreeDistance wall(windingTree(40), 1);
  EXPECT_NEAR(wall.nearest({4, 2, 1}).distance, 1.5, 1e-6);
}

TEST(TubeTreeDistance, ABranchOfOneNodeIsASphere) {
  formats::CenterlineTree tree = windingTree(1);
  tree.branches.pop_back();
  EXPECT_NEAR(TubeTreeDistance(tree).nearest({0, 0, 4}).distance, 2, 1e-6);
}

TEST(TubeTreeDistance, AnEmptyTreeIsInfinitelyFar) {
  EXPECT_TRUE(std::isinf(TubeTreeDistance(formats::CenterlineTree{}).nearest({0, 0, 0}).distance));
}

}  // namespace
}  // namespace lumen
