// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/patch.h"

#include <gtest/gtest.h>

#include "../mesh/mesh_facts.h"

namespace lumen::convert {
namespace {

// The tetrahedron with corners at the origin and at 1 on each axis: volume 1/6.
TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(Clip, LeavesTheInnerPartWithItsNewVerticesOnThePlane) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 0.5}, 0);
  const test::MeshFacts facts = test::measureFacts(patch);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.boundary.size(), 3U);  // a triangle of the tetrahedron's cross-section
  for (const std::uint32_t v : facts.boundary) EXPECT_EQ(patch.position[v].x(), 0.5);
  // The outline is shared: three vertices at x = 0 and three at x = 0.5, nothing twice.
  EXPECT_EQ(patch.position.size(), 6U);
  // Surface: the face x = 0 is 1/2; three quarters remain of the two faces of 1/2 and of the
  // slanted one.
  EXPECT_NEAR(facts.area, 0.5 + 0.75 * (0.5 + 0.5 + std::sqrt(3.0) / 2), 1e-12);
}

TEST(Clip, KeepsAPatchThatLiesInside) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 1}, 0);
  EXPECT_EQ(patch.position.size(), 4U);
  EXPECT_EQ(patch.triangle.size(), 4U);
}

TEST(Clip, DropsAPatchThatLiesOutside) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), -0.5}, 0);
  EXPECT_TRUE(patch.position.empty());
  EXPECT_TRUE(patch.triangle.empty());
}

TEST(Clip, AVertexWithinTheSnapIsOnThePlane) {
  TriangleMesh patch = tetrahedron();
  clip(patch, {Eigen::Vector3d::UnitX(), 0.999}, 0.01);
  EXPECT_EQ(patch.triangle.size(), 4U);  // uncut
}

TEST(DropFarParts, KeepsAPartWithOneVertexNearEnough) {
  TriangleMesh patch = tetrahedron();
  dropFarParts(patch, {-2, 0, 0}, 2);  // the origin is 2 away, the others farther
  EXPECT_EQ(patch.triangle.size(), 4U);
  dropFarParts(patch, {-2, 0, 0}, 1.9);
  EXPECT_TRUE(patch.triangle.empty());
  EXPECT_TRUE(patch.position.empty());
}

TEST(RoundToFloat, JoinsVerticesThatBecomeOneAndKeepsTheSurfaceClosed) {
  // Vertex 4 splits the edge from 1 to 2 and lies 1e-12 from vertex 1, a thousandth of what a float
  // resolves.
  TriangleMesh patch{{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {2 - 1e-12, 1 + 1e-12, 1}},
                     {{0, 2, 4}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 4, 3}, {4, 2, 3}}};
  EXPECT_EQ(test::measureFacts(patch).boundaryEdges, 0U);
  roundToFloat(patch);
  EXPECT_EQ(patch.position.size(), 4U);
  EXPECT_EQ(patch.triangle.size(), 4U);
  EXPECT_EQ(test::measureFacts(patch).boundaryEdges, 0U);
}

TEST(SeparateFans, SplitsAVertexWhereTwoSurfacesTouch) {
  TriangleMesh patch = tetrahedron();
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, -1)})
    patch.position.push_back(p);
  for (const Triangle& t :
       {Triangle{0, 4, 5}, Triangle{0, 6, 4}, Triangle{0, 5, 6}, Triangle{4, 6, 5}})
    patch.triangle.push_back(t);
  separateFans(patch);
  ASSERT_EQ(patch.position.size(), 8U);
  EXPECT_EQ(patch.position[7], Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(test::measureFacts(patch).euler, 4);  // two spheres
}

TEST(SeparateFans, CutsAnEdgeOfFourTriangles) {
  // Two tetrahedra on either side of a common edge from 0 to 3.
  TriangleMesh patch = tetrahedron();
  patch.position.push_back({-1, 0, 0});
  patch.position.push_back({0, -1, 0});
  for (const Triangle& t :
       {Triangle{0, 5, 4}, Triangle{0, 4, 3}, Triangle{0, 3, 5}, Triangle{4, 5, 3}})
    patch.triangle.push_back(t);
  EXPECT_EQ(test::measureFacts(patch).badEdges, 1U);
  separateFans(patch);
  EXPECT_EQ(test::measureFacts(patch).badEdges, 0U);
}

}  // namespace
}  // namespace lumen::convert
