// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include "tests/unit/trees_from_surfaces/tube_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

TEST(TriangleTree, FindsTheWallOfATubeFromItsAxis) {
  const TriangleMesh mesh = test::tube(test::straight(20), 2, true, 64);
  const TriangleTree tree(mesh);
  const auto hit = tree.firstHit({10.1, 0, 0}, Vector3d::UnitY());
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->leaves);
  EXPECT_NEAR(hit->distance, 2, 0.003);  // 64 sides: 1 - cos(pi/64) of the radius
  const auto entering = tree.firstHit({10.1, 5, 0}, -Vector3d::UnitY());
  ASSERT_TRUE(entering);
  EXPECT_FALSE(entering->leaves);
  EXPECT_NEAR(tree.nearest({10, 1.5, 0}).distance, 0.5, 0.003);
}

TEST(TriangleTree, KnowsWhatATubeContains) {
  const TriangleMesh mesh = test::tube(test::straight(20), 2, true);
  const TriangleTree tree(mesh);
  EXPECT_TRUE(tree.contains({10, 1.9, 0}));
  EXPECT_FALSE(tree.contains({10, 2.1, 0}));
  EXPECT_FALSE(tree.contains({20.1, 0, 0}));
  EXPECT_FALSE(tree.isFree({10, 0, 0}, {10, 3, 0}));
  EXPECT_TRUE(tree.isFree({1, 0, 0}, {19, 0, 0}));
}

TEST(TriangleTree, FindsTheSameAsALookAtEveryTriangle) {
  const TriangleMesh mesh = test::ring(6, 2, 40, 12);
  const TriangleTree tree(mesh);
  for (int i = 0; i < 60; ++i) {
    const Vector3d from(std::sin(i * 1.7) * 9, std::cos(i * 2.3) * 9, std::sin(i * 0.9) * 3);
    double least = 1e9;
    for (const Triangle& t : mesh.triangle) {
      const TriangleMesh one{{mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]},
                             {{0, 1, 2}}};
      least = std::min(least, TriangleTree(one).nearest(from).distance);
    }
    EXPECT_EQ(tree.nearest(from).distance, least);
  }
}

}  // namespace
}  // namespace lumen::convert
