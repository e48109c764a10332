// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../surface/closed_cases.h"
#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/base/vectors.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/volume_mesh/make_volume_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// A case with its closed surface and the cells within.
struct Filled {
  formats::Case source;
  ClosedSurface surface;
  MadeVolumeMesh made;
};

Filled filled(const formats::Case& source, const VolumeMeshOptions& options,
              ClosedSurfaceOptions closed = {}) {
  Progress silent;
  Filled result{source, closedSurface(source, closed, silent), {}};
  result.made =
      makeVolumeMesh(source, result.surface.levels[0], result.surface.report.gap, options, silent);
  return result;
}

VolumeMeshOptions withLayers(int layers, double growth, Length height) {
  VolumeMeshOptions options;
  options.layers = layers;
  options.growth = growth;
  options.height = height;
  return options;
}

/// Tests that need the program lumen-netgen, which is built where Netgen is.
class VolumeMeshTest : public ::testing::Test {
protected:
  void SetUp() override {
    if (!installedProgram("lumen-netgen")) GTEST_SKIP() << "lumen-netgen is not in PATH";
  }
};

/// Area of each group of the boundary, by its name.
std::map<std::string, double> areas(const VolumeMesh& mesh) {
  std::map<std::string, double> area;
  for (const BoundaryFace& face : mesh.boundary) {
    const auto at = [&](std::size_t k) { return mesh.position[face.corner[k]]; };
    double& sum = area[mesh.groups[face.group].name];
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    if (face.corner[3] != kAbsent) sum += 0.5 * (at(2) - at(0)).cross(at(3) - at(0)).norm();
  }
  return area;
}

std::map<std::string, double> areas(const SurfaceMesh& surface) {
  std::map<std::string, double> area;
  const auto at = [&](std::uint32_t v) { return toEigen(surface.position[v]); };
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const Triangle& c = surface.triangle[t];
    area[surface.groups[surface.group[t]].name] +=
        0.5 * (at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).norm();
  }
  return area;
}

/// All that holds for every volume mesh.
void expectSound(const Filled& result) {
  const VolumeMesh& mesh = result.made.mesh;
  double sum = 0, least = 1;
  for (std::size_t cell = 0; cell < mesh.cells(); ++cell) {
    sum += cellVolume(mesh, cell);
    EXPECT_GT(cellVolume(mesh, cell), 0) << cell;
    least = std::min(least, cellQuality(mesh, cell));
  }
  const VolumeMeshReport& report = result.made.report;
  EXPECT_GT(least, 0);
  EXPECT_EQ(least, report.leastQuality);
  EXPECT_NEAR(sum, report.volume, 1e-9 * sum);
  EXPECT_NEAR(report.surfaceVolume, sum, 1e-7 * sum);
  EXPECT_EQ(report.prisms, mesh.prism.size());
  EXPECT_EQ(report.tetrahedra, mesh.tetrahedron.size());
  EXPECT_EQ(report.points, mesh.position.size());
  std::size_t named = 0;
  for (const CellFace& face : cellFaces(mesh)) named += face.neighbour == kAbsent ? 1U : 0U;
  EXPECT_EQ(named, mesh.boundary.size());
  const auto expected = areas(result.surface.levels[0]);
  const auto found = areas(mesh);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, area] : expected) EXPECT_NEAR(found.at(name), area, 1e-5 * area) << name;
  const std::set<std::uint32_t> used = [&] {
    std::set<std::uint32_t> vertices;
    for (const auto& p : mesh.prism) vertices.insert(p.begin(), p.end());
    for (const auto& t : mesh.tetrahedron) vertices.insert(t.begin(), t.end());
    return vertices;
  }();
  EXPECT_EQ(used.size(), mesh.position.size());
}

std::size_t wallTriangles(const SurfaceMesh& surface) {
  std::size_t count = 0;
  for (const std::uint32_t group : surface.group)
    count += surface.groups[group].kind == FaceKind::Wall ? 1U : 0U;
  return count;
}

TEST_F(VolumeMeshTest, HasTheLayersOfATubeThatWereAskedFor) {
  const Filled tube = filled(test::tubeCase(10), withLayers(4, 1.5, {0.02, 0}));
  expectSound(tube);
  const VolumeMesh& mesh = tube.made.mesh;
  ASSERT_EQ(mesh.prism.size(), 4 * wallTriangles(tube.surface.levels[0]));
  EXPECT_GT(tube.made.report.leastQuality, 0.1);
  EXPECT_EQ(tube.made.report.fullLayers, 1);
  EXPECT_EQ(tube.made.report.leastLayers, 1);
  for (std::size_t cell = 0; cell < mesh.prism.size(); cell += 4)
    for (std::size_t layer = 0; layer < 4; ++layer)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& prism = mesh.prism[cell + layer];
        const double height = (mesh.position[prism[k + 3]] - mesh.position[prism[k]]).norm();
        ASSERT_NEAR(height, 0.02 * std::pow(1.5, layer), 1e-6);
        if (layer == 0) continue;
        ASSERT_EQ(prism[k], mesh.prism[cell + layer - 1][k + 3]);
      }
}

TEST_F(VolumeMeshTest, HasLayersAsSharesOfTheRadius) {
  const Filled tube = filled(test::tubeCase(10), withLayers(2, 1, {0, 0.05}));
  const VolumeMesh& mesh = tube.made.mesh;
  const double radius = double{tube.source.tree.radius[0]};
  const auto& prism = mesh.prism[mesh.prism.size() / 2];
  EXPECT_NEAR((mesh.position[prism[3]] - mesh.position[prism[0]]).norm(), 0.05 * radius,
              1e-3 * radius);
}

TEST_F(VolumeMeshTest, LayersFollowTheNormalsOfTheField) {
  const Filled tube = filled(test::tubeCase(12), withLayers(1, 1, {0, 0.1}));
  const VolumeMesh& mesh = tube.made.mesh;
  // in the middle of a tube along x, normals point to its axis
  std::size_t seen = 0;
  for (const auto& prism : mesh.prism) {
    const Vector3d& wall = mesh.position[prism[0]];
    const Vector3d& inner = mesh.position[prism[3]];
    if (std::abs(wall.x() - 5.5) > 2) continue;
    ++seen;
    const Vector3d out(0, wall.y(), wall.z());
    EXPECT_GT((wall - inner).normalized().dot(out.normalized()), 0.995);
  }
  EXPECT_GT(seen, 100U);
}

TEST_F(VolumeMeshTest, RimsOfEndsStayInTheirPlanes) {
  const Filled tube = filled(test::tubeCase(10), withLayers(3, 1.2, {0, 0.05}));
  const VolumeMesh& mesh = tube.made.mesh;
  double least = 1e9, most = -1e9;
  for (const BoundaryFace& face : mesh.boundary) {
    if (mesh.groups[face.group].name != "inlet") continue;
    for (const std::uint32_t c : face.corner)
      if (c != kAbsent) {
        least = std::min(least, mesh.position[c].x());
        most = std::max(most, mesh.position[c].x());
      }
  }
  EXPECT_LT(most - least, 1e-5);
}

TEST_F(VolumeMeshTest, FillsAForkWithThreeNamedEnds) {
  const Filled fork = filled(test::forkCase(), {});
  expectSound(fork);
  EXPECT_EQ(areas(fork.made.mesh).size(), 4U);
  EXPECT_GT(fork.made.report.leastQuality, 0.05);
}

TEST_F(VolumeMeshTest, LayersShrinkWhereTheyWouldMeet) {
  const Filled fork = filled(test::forkCase(), withLayers(8, 1.3, {0, 0.1}));
  expectSound(fork);
  EXPECT_LT(fork.made.report.leastLayers, 0.5);
  EXPECT_LT(fork.made.report.fullLayers, 0.5);
}

TEST_F(VolumeMeshTest, FillsFlowExtensions) {
  ClosedSurfaceOptions closed;
  closed.extend = {{"", {0, 3}}};
  expectSound(filled(test::forkCase(), {}, closed));
}

TEST_F(VolumeMeshTest, HasTetrahedraAloneWithoutLayers) {
  const Filled fork = filled(test::forkCase(), withLayers(0, 1, {0, 1}));
  expectSound(fork);
  EXPECT_TRUE(fork.made.mesh.prism.empty());
  EXPECT_EQ(fork.made.mesh.boundary.size(), fork.surface.levels[0].triangle.size());
}

TEST_F(VolumeMeshTest, FillsVesselsThatTouch) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "a", test::straightPath({0, 0, 0}, {1, 0, 0}, 10), 1.0, 1.0);
  test::addVessel(source, "b", test::straightPath({0, 1.9, 0}, {1, 0, 0}, 10), 1.0, 1.0);
  test::addModels(source);
  const Filled both = filled(source, {});
  expectSound(both);
  EXPECT_EQ(areas(both.made.mesh).size(), 5U);
}

TEST_F(VolumeMeshTest, IsTheSameEachTime) {
  const Filled one = filled(test::tubeCase(6), {}), other = filled(test::tubeCase(6), {});
  EXPECT_EQ(encodeVtu(one.made.mesh), encodeVtu(other.made.mesh));
}

TEST_F(VolumeMeshTest, PrismsBecomeTetrahedraThatMeet) {
  const Filled fork = filled(test::forkCase(), withLayers(2, 1.2, {0, 0.05}));
  const VolumeMesh split = asTetrahedra(fork.made.mesh);
  EXPECT_EQ(split.cells(), 3 * fork.made.mesh.prism.size() + fork.made.mesh.tetrahedron.size());
  double sum = 0;
  for (std::size_t cell = 0; cell < split.cells(); ++cell) {
    EXPECT_GT(cellVolume(split, cell), 0);
    sum += cellVolume(split, cell);
  }
  EXPECT_NEAR(sum, fork.made.report.surfaceVolume, 1e-6 * sum);
  EXPECT_NO_THROW(cellFaces(split));
}

/// A prism on the triangle (0, 0, 1), (1, 0, 1), (0, 1, 1), with the wall above and a tetrahedron below it.
VolumeMesh smallMesh() {
  VolumeMesh mesh;
  mesh.position = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  mesh.prism = {{0, 1, 2, 3, 4, 5}};
  mesh.tetrahedron = {{3, 5, 4, 6}};
  mesh.groups = {{"wall", FaceKind::Wall}, {"inlet", FaceKind::Inlet}};
  mesh.boundary = {{{0, 1, 2, kAbsent}, 0}, {{0, 3, 4, 1}, 1},       {{1, 4, 5, 2}, 1},
                   {{2, 5, 3, 0}, 1},       {{3, 6, 4, kAbsent}, 1}, {{4, 6, 5, kAbsent}, 1},
                   {{3, 5, 6, kAbsent}, 1}};
  return mesh;
}

TEST(VolumeCells, HaveVolumesAndQualities) {
  const VolumeMesh mesh = smallMesh();
  EXPECT_NEAR(cellVolume(mesh, 0), 0.5, 1e-12);
  EXPECT_NEAR(cellVolume(mesh, 1), 1.0 / 6, 1e-12);
  // the least corner of the triangle has an angle of 45 degrees
  EXPECT_NEAR(cellQuality(mesh, 0), std::sqrt(0.5) * 2 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(cellQuality(mesh, 1), 0.5 * std::sqrt(2.0), 1e-12);
}

TEST(VolumeCells, TurnedOverAreNegative) {
  VolumeMesh mesh = smallMesh();
  mesh.position[6] = {0, 0, 0.5};
  EXPECT_LT(cellVolume(mesh, 1), 0);
  EXPECT_LT(cellQuality(mesh, 1), 0);
  mesh.position[5].z() = 2;
  EXPECT_LT(cellQuality(mesh, 0), 0);
}

TEST(VolumeFaces, AreOrderedWithTheBoundaryLast) {
  const std::vector<CellFace> faces = cellFaces(smallMesh());
  ASSERT_EQ(faces.size(), 8U);
  EXPECT_EQ(faces[0].owner, 0U);
  EXPECT_EQ(faces[0].neighbour, 1U);
  EXPECT_EQ(faces[1].group, 0U);
  for (std::size_t k = 2; k < 8; ++k) EXPECT_EQ(faces[k].group, 1U);
}

TEST(VolumeFaces, ThatAreOpenOrTwiceThereAreRefused) {
  VolumeMesh open = smallMesh();
  open.boundary.pop_back();
  EXPECT_THROW(cellFaces(open), Error);
  VolumeMesh doubled = smallMesh();
  doubled.boundary.push_back(doubled.boundary.front());
  EXPECT_THROW(cellFaces(doubled), Error);
  VolumeMesh turned = smallMesh();
  std::swap(turned.boundary[0].corner[0], turned.boundary[0].corner[1]);
  EXPECT_THROW(cellFaces(turned), Error);
}

TEST(VolumeLayers, SumTheirHeights) {
  EXPECT_NEAR(withLayers(3, 1.25, {}).heights(), 1 + 1.25 + 1.5625, 1e-12);
  EXPECT_EQ(withLayers(0, 2, {}).heights(), 0);
}

}  // namespace
}  // namespace lumen::convert
