// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/mesh_parts.h"

#include <set>

#include <gtest/gtest.h>

#include "capped_tube.h"

namespace lumen::convert {
namespace {

TEST(IsClosed, ATubeWithEndsIsAndOneWithoutIsNot) {
  EXPECT_TRUE(isClosed(test::cappedTube({"a"})));
  EXPECT_FALSE(isClosed(test::openTube({"a"})));
  EXPECT_TRUE(isClosed({}));
}

TEST(IsClosed, ATurnedFaceOpensASurface) {
  SurfaceMesh surface = test::cappedTube({"a"});
  std::swap(surface.triangle[5][0], surface.triangle[5][1]);
  EXPECT_FALSE(isClosed(surface));
}

TEST(PartsOf, AFaceBelongsToTheBranchOfTwoOfItsVertices) {
  SurfaceMesh surface;
  surface.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  surface.normal.assign(4, {0, 0, 1});
  surface.radius.assign(4, 1);
  surface.branch = {0, 1, 1, 2};
  surface.labels = {"a", "b", "c"};
  surface.groups = {{"wall", FaceKind::Wall}};
  // vertices of b twice; of three branches
  surface.triangle = {{0, 1, 2}, {3, 0, 1}};
  surface.group = {0, 0};
  const auto parts = splitMesh(surface, MeshPer::Branch);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].branch, 1U);
  EXPECT_EQ(parts[0].vertex, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(parts[1].branch, 2U);
  EXPECT_EQ(parts[1].vertex, (std::vector<std::uint32_t>{3, 0, 1}));
}

TEST(PartsOf, EachGroupHasItsVerticesOnceAndThoseOfRimsAreInTwo) {
  const SurfaceMesh surface = test::cappedTube({"a"});
  const auto parts = splitMesh(surface, MeshPer::Whole);
  ASSERT_EQ(parts.size(), 3U);
  std::size_t vertices = 0, triangles = 0;
  for (const MeshPart& part : parts) {
    EXPECT_EQ(std::set(part.vertex.begin(), part.vertex.end()).size(), part.vertex.size());
    EXPECT_EQ(part.isFlat, part.group > 0);
    vertices += part.vertex.size();
    triangles += part.triangle.size();
  }
  EXPECT_EQ(vertices, surface.position.size() + 2 * 12);
  EXPECT_EQ(triangles, surface.triangle.size());
}

}  // namespace
}  // namespace lumen::convert
