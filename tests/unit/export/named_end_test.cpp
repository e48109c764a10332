// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "converters/export/shared/insertion.h"

namespace lumen::convert {

namespace {

/// A box of 4 by 2 by 10 along z, open groups at both ends; the wall is group 0.
SurfaceMesh box() {
  SurfaceMesh mesh;
  for (const float z : {0.0F, 10.0F})
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {4.0F, 0.0F}, {4.0F, 2.0F}, {0.0F, 2.0F}})
      mesh.position.push_back({x, y, z});
  mesh.groups = {
      {"wall", FaceKind::Wall}, {"inlet", FaceKind::Inlet}, {"outlet-a", FaceKind::Outlet}};
  const auto add = [&mesh](std::uint32_t group, const Triangle& t) {
    mesh.triangle.push_back(t);
    mesh.group.push_back(group);
  };
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    add(0, {i, j, j + 4});
    add(0, {i, j + 4, i + 4});
  }
  add(1, {0, 2, 1});
  add(1, {0, 3, 2});
  add(2, {4, 5, 6});
  add(2, {4, 6, 7});
  return mesh;
}

/// A tube of square section along z with a thick wall: group 0 is the lumen's side, 1 the outer one, and the rings
/// between them are the ends. Corners 0 to 3 are the lumen's at z = 0, 4 to 7 at z = 10, 8 to 15 those outside.
SurfaceMesh thickTube() {
  SurfaceMesh mesh;
  for (const float half : {1.0F, 2.0F})
    for (const float z : {0.0F, 10.0F})
      for (const auto& [x, y] :
           {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}})
        mesh.position.push_back({half * x, half * y, z});
  mesh.groups = {{"wall", FaceKind::Wall},
                 {"outer wall", FaceKind::Wall},
                 {"inlet", FaceKind::Inlet},
                 {"outlet-a", FaceKind::Outlet}};
  const auto add = [&mesh](std::uint32_t group, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                           std::uint32_t d) {
    for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
      mesh.triangle.push_back(t);
      mesh.group.push_back(group);
    }
  };
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    add(0, j, i, i + 4, j + 4);  // normals into the lumen, out of the solid
    add(1, i + 8, j + 8, j + 12, i + 12);
    add(2, i, j, j + 8, i + 8);            // down
    add(3, i + 12, j + 12, j + 4, i + 4);  // up
  }
  return mesh;
}

formats::CenterlineTree chain(std::size_t nodes) {
  formats::CenterlineTree tree;
  for (std::size_t i = 0; i < nodes; ++i) {
    tree.centre.push_back({0, 0, static_cast<float>(i)});
    tree.direction.push_back({0, 0, 1});
    tree.radius.push_back(1.5F);
    tree.height.push_back(1);
    tree.parent.push_back(static_cast<std::int32_t>(i) - 1);
    tree.branch.push_back(0);
  }
  formats::Branch& branch = tree.branches.emplace_back();
  branch.label.assign(1, 'a');  // gcc 12 warns of "a"
  branch.nodeCount = static_cast<std::uint32_t>(nodes);
  return tree;
}

}  // namespace

TEST(NamedEnd, OfASurfaceHasItsMiddleItsWayOutAndItsArea) {
  const auto ends = findEnds(box());
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].name, "inlet");
  EXPECT_TRUE(ends[0].position.isApprox(Eigen::Vector3d(2, 1, 0)));
  EXPECT_TRUE(ends[0].direction.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(ends[1].name, "outlet-a");
  EXPECT_TRUE(ends[1].position.isApprox(Eigen::Vector3d(2, 1, 10)));
  EXPECT_TRUE(ends[1].direction.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(ends[1].radius, std::sqrt(8 / 3.14159265358979), 1e-9);
}

TEST(NamedEnd, OfAThickWallLooksOutOfTheVessel) {
  const auto ends = findEnds(thickTube());
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].name, "inlet");
  EXPECT_TRUE(ends[0].direction.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(ends[0].position.isApprox(Eigen::Vector3d(0, 0, 0)));
  EXPECT_EQ(ends[1].name, "outlet-a");
  EXPECT_TRUE(ends[1].direction.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(ends[1].radius, std::sqrt(4 / 3.14159265358979), 1e-9);  // of the lumen
}

TEST(NamedEnd, OfATreeAreItsFirstAndLastNodes) {
  const auto ends = findEnds(chain(4));
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].name, "inlet");
  EXPECT_EQ(ends[0].direction, -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(ends[1].name, "outlet-a");
  EXPECT_EQ(ends[1].position, Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(ends[1].radius, 1.5);
}

TEST(NamedEnd, OfATreeIsNoneWhereALinkGoesOn) {
  auto tree = chain(4);
  tree.links = {{{1, 3}}};
  EXPECT_EQ(findEnds(tree).size(), 1U);
}

}  // namespace lumen::convert
