// SPDX-License-Identifier: Apache-2.0
// OBJ, STL and PLY. tests/vtk/compare_meshes.py checks that VTK reads them, and VTP, as they were.
#include "converters/io/mesh/write_plain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>
#include <vector>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <gtest/gtest.h>

#include "capped_tube.h"
#include "converters/base/error.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "open_mesh.h"

namespace lumen::convert {
namespace {

using test::cappedTube;
using test::hostileLabels;
using test::TriMesh;

// OpenMesh's readers take a stream; the extension chooses the format.
TriMesh readBack(const std::string& bytes, const char* extension) {
  TriMesh mesh;
  std::istringstream stream(bytes);
  OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexNormal);
  if (std::string(extension) != ".OBJ") options += OpenMesh::IO::Options::Binary;
  EXPECT_TRUE(OpenMesh::IO::read_mesh(mesh, stream, extension, options));
  return mesh;
}

void expectVerticesAndFaces(TriMesh& mesh, const SurfaceMesh& surface) {
  ASSERT_EQ(mesh.n_vertices(), surface.position.size());
  ASSERT_EQ(mesh.n_faces(), surface.triangle.size());
  for (const auto v : mesh.vertices())
    EXPECT_EQ(mesh.point(v),
              TriMesh::Point(surface.position[static_cast<std::size_t>(v.idx())].data()));
  std::multiset<std::set<int>> found, true_;
  for (const auto f : mesh.faces()) {
    std::set<int> corners;
    for (const auto v : mesh.fv_range(f)) corners.insert(v.idx());
    found.insert(corners);
  }
  for (const Triangle& t : surface.triangle) true_.insert({int(t[0]), int(t[1]), int(t[2])});
  EXPECT_EQ(found, true_);
}

std::vector<std::string> splitLines(const std::string& text, const std::string& start) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with(start)) lines.push_back(line.substr(start.size()));
  return lines;
}

TEST(Systems, AreStatedWhereTheyAreKnown) {
  SurfaceMesh surface = cappedTube({"a", "b"});
  const auto texts = [&] { return std::vector{encodePly(surface), encodeVtp(surface)}; };
  for (const std::string& text : texts()) {
    EXPECT_EQ(text.find("comment system"), std::string::npos);
    EXPECT_EQ(text.find("BranchSystems"), std::string::npos);
  }
  EXPECT_THROW((void)measureColorScale(surface, ColorBy::System), Error);
  surface.systems = {formats::VesselSystem::Vein, formats::VesselSystem::Unknown};
  EXPECT_EQ(splitLines(texts()[0], "comment system "),
            (std::vector<std::string>{"0 vein", "1 unknown"}));
  EXPECT_NE(texts()[1].find("BranchSystems"), std::string::npos);
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::System));
  ASSERT_EQ(colors.size(), surface.position.size());
  EXPECT_GT(colors[0][2], colors[0][0]);  // blue
}

TEST(Obj, ReadsBackWithItsNormals) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  const std::string text = encodeObj(surface);
  TriMesh mesh = readBack(text, ".OBJ");
  expectVerticesAndFaces(mesh, surface);
  EXPECT_EQ(splitLines(text, "# millimetres, LPS").size(), 1U);
  // the rims' vertices have the ends' normals last
  EXPECT_EQ(mesh.normal(TriMesh::VertexHandle(0)), TriMesh::Normal(0, 0, -1));
  EXPECT_EQ(mesh.normal(TriMesh::VertexHandle(13)), TriMesh::Normal(surface.normal[13].data()));
}

TEST(Obj, NamesItsGroupsInOneWordEach) {
  const std::string text = encodeObj(cappedTube({"side a\nv 1 2 3", "b"}));
  EXPECT_EQ(splitLines(text, "g "),
            (std::vector<std::string>{"wall", "inlet-side_a_v_1_2_3", "outlet-b"}));
}

TEST(Ply, ReadsBackWithItsNormals) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  TriMesh mesh = readBack(encodePly(surface), ".PLY");
  expectVerticesAndFaces(mesh, surface);
  for (const auto v : mesh.vertices())
    EXPECT_EQ(mesh.normal(v),
              TriMesh::Normal(surface.normal[static_cast<std::size_t>(v.idx())].data()));
}

// The properties that OpenMesh leaves out, by the sizes that the header states.
TEST(Ply, HasRadiusConfidenceAndBranchOfVerticesAndGroupsOfFaces) {
  const SurfaceMesh surface = cappedTube({"low", "high"});
  const std::string bytes = encodePly(surface);
  const std::string end = "end_header\n";
  const std::size_t header = bytes.find(end) + end.size();
  EXPECT_EQ(splitLines(bytes.substr(0, header), "comment group "),
            (std::vector<std::string>{"1 wall", "2 inlet-low", "3 outlet-high"}));
  EXPECT_EQ(splitLines(bytes.substr(0, header), "comment branch "),
            (std::vector<std::string>{"0 low", "1 high"}));
  const std::size_t vertices = surface.position.size(), faces = surface.triangle.size();
  ASSERT_EQ(bytes.size(), header + 36 * vertices + 17 * faces);
  for (std::size_t v = 0; v < vertices; ++v) {
    std::array<float, 2> values{};
    std::int32_t branch = -1;
    std::memcpy(values.data(), bytes.data() + header + 36 * v + 24, 8);
    std::memcpy(&branch, bytes.data() + header + 36 * v + 32, 4);
    EXPECT_EQ(values, (std::array{surface.radius[v], surface.confidence[v]}));
    EXPECT_EQ(branch, static_cast<int>(surface.branch[v]));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::int32_t group = 0;
    std::memcpy(&group, bytes.data() + header + 36 * vertices + 17 * f + 13, 4);
    EXPECT_EQ(group, static_cast<int>(surface.group[f]) + 1);
  }
}

TEST(Stl, HasFiftyBytesPerTriangleAndUnitNormals) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  const std::string bytes = encodeStl(surface, false);
  const std::size_t faces = surface.triangle.size();
  ASSERT_EQ(bytes.size(), 84 + 50 * faces);
  EXPECT_NE(bytes.substr(0, 80).find("mm, SPACE=LPS"), std::string::npos);
  EXPECT_FALSE(bytes.starts_with("solid"));
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(count, faces);
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<float, 12> facet{};
    std::uint16_t rest = 1;
    std::memcpy(facet.data(), bytes.data() + 84 + 50 * f, sizeof facet);
    std::memcpy(&rest, bytes.data() + 84 + 50 * f + 48, 2);
    EXPECT_NEAR(std::hypot(facet[0], facet[1], facet[2]), 1, 1e-6);
    EXPECT_EQ(rest, 0);
  }
  EXPECT_EQ(readBack(bytes, ".STL").n_faces(), faces);
}

TEST(Stl, HasOneSolidForEachGroupOnRequest) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  const std::string text = encodeStl(surface, true);
  const std::vector<std::string> names{"wall", "inlet-a_solid_b_c", "outlet-_"};
  EXPECT_EQ(splitLines(text, "solid "), names);
  EXPECT_EQ(splitLines(text, "endsolid "), names);
  EXPECT_EQ(splitLines(text, "facet normal ").size(), surface.triangle.size());
  EXPECT_EQ(splitLines(text, "vertex ").size(), 3 * surface.triangle.size());
}

TEST(Vtp, IsXmlWithoutNamesInIt) {
  for (const std::string& label : hostileLabels()) {
    const std::string text = encodeVtp(cappedTube({label}));
    EXPECT_EQ(text.find(label.size() > 1 ? label : "\\\\"), std::string::npos);
    EXPECT_EQ(std::count(text.begin(), text.end(), '<'), std::count(text.begin(), text.end(), '>'));
  }
}

TEST(PlainNames, AreOneWordOnceEach) {
  EXPECT_EQ(distinct({"a b", "a_b", "a\tb", "", "c"}, oneWord),
            (std::vector<std::string>{"a_b", "a_b_2", "a_b_3", "_", "c"}));
  EXPECT_EQ(oneWord("c\u00f4t\u00e9"), "c\u00f4t\u00e9");
}

TEST(PlainNames, OfOpenFoamAreAsciiWords) {
  EXPECT_EQ(openFoamWord("c\u00f4t\u00e9 {1};\"x\""), "c_t___1___x_");
  EXPECT_EQ(openFoamWord(""), "_");
  EXPECT_EQ(openFoamWord(std::string(300, 'x')), std::string(100, 'x'));
}

TEST(PlainFormats, GiveTheSameBytesEachTime) {
  const SurfaceMesh surface = cappedTube(hostileLabels());
  EXPECT_EQ(encodeObj(surface), encodeObj(surface));
  EXPECT_EQ(encodePly(surface), encodePly(surface));
  EXPECT_EQ(encodeStl(surface, false), encodeStl(surface, false));
  EXPECT_EQ(encodeVtp(surface), encodeVtp(surface));
}

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

SurfaceMesh withRadii(const std::vector<float>& radii) {
  SurfaceMesh surface;
  surface.radius = radii;
  surface.position.resize(radii.size());
  return surface;
}

/// ITU-R BT.709.
double luminance(const Color& c) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

TEST(VertexColor, GetsLighterWithTheValue) {
  std::vector<float> radii;
  for (int i = 0; i <= 100; ++i) radii.push_back(1 + 0.09F * static_cast<float>(i));
  const SurfaceMesh surface = withRadii(radii);
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  for (std::size_t i = 1; i < colors.size(); ++i)
    EXPECT_GT(luminance(colors[i]), luminance(colors[i - 1])) << i;
}

TEST(VertexColor, OfARadiusGoesWithItsLogarithm) {
  // 1 to 100: 10 lies halfway, where viridis is sRGB 33, 145, 140 (linear light by IEC 61966-2-1)
  const SurfaceMesh surface = withRadii({1, 10, 100});
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  EXPECT_NEAR(colors[1][0], 0.0152 * 65535, 10);
  EXPECT_NEAR(colors[1][1], 0.2832 * 65535, 10);
  EXPECT_NEAR(colors[1][2], 0.2623 * 65535, 10);
}

TEST(VertexColor, OfOneRadiusOnlyIsOneColor) {
  const SurfaceMesh surface = withRadii({2, 2});
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Radius));
  EXPECT_EQ(colors[0], colors[1]);
}

TEST(VertexColor, SevenBranchesDifferAndTheEighthIsAsTheFirst) {
  SurfaceMesh surface;
  surface.branch = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto colors = vertexColors(surface, measureColorScale(surface, ColorBy::Branch));
  EXPECT_EQ(std::set(colors.begin(), colors.end()).size(), 7U);
  EXPECT_EQ(colors[7], colors[0]);
}

}  // namespace
}  // namespace lumen::convert
