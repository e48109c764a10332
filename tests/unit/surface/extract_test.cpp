// SPDX-License-Identifier: Apache-2.0
// The closed surface of a case: what it must be whatever the case.
#include "converters/stages/surface/extract.h"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "../mesh/mesh_facts.h"
#include "../mesh/synthetic.h"
#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/marching_tetrahedra.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "formats/case/case_field.h"

namespace lumen {
namespace {

struct Extracted {
  formats::Case source;
  field::BlendedField blended;
  convert::SeparatedField field;
  convert::ExtractionReport report;
  convert::CaseSurface surface;

  explicit Extracted(formats::Case value, double share = 1.0)
      : source(std::move(value)),
        blended(formats::caseField(source)),
        field(source, blended, {0.02, 0, 0}) {
    Progress silent;
    surface = convert::extractSurface(field, share, report, silent);
  }

  /// Euler characteristics of the connected parts, by their least vertex.
  [[nodiscard]] std::vector<std::ptrdiff_t> eulerOfParts() const {
    convert::DisjointSets sets(surface.mesh.position.size());
    for (const auto& t : surface.mesh.triangle) {
      sets.join(t[0], t[1]);
      sets.join(t[1], t[2]);
    }
    std::map<std::uint32_t, std::ptrdiff_t> euler;  // V - F / 2 of a closed surface
    for (std::uint32_t v = 0; v < surface.mesh.position.size(); ++v) euler[sets.find(v)] += 2;
    for (const auto& t : surface.mesh.triangle) euler[sets.find(t[0])] -= 1;
    std::vector<std::ptrdiff_t> result;
    for (const auto& [part, twice] : euler) result.push_back(twice / 2);
    return result;
  }
};

void expectClosed(const Extracted& made) {
  const test::MeshFacts facts = test::measureFacts(made.surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_GT(facts.volume, 0);
}

// A ring of twelve nodes closed by a link.
formats::Case ringCase() {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  std::vector<Eigen::Vector3d> path;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * std::numbers::pi * i / 24;
    path.emplace_back(4 * std::cos(angle), 4 * std::sin(angle), 0);
  }
  test::addVessel(result, "ring", path, 0.8, 1.0);
  result.tree.links.push_back({0, 23});
  test::addModels(result);
  return result;
}

// Two tubes side by side whose walls overlap by 2 - apart mm.
formats::Case pairCase(double apart) {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  test::addVessel(result, "one", test::straightPath({0, 0, 0}, {1, 0, 0}, 20), 1.0, 1.0);
  test::addVessel(result, "two", test::straightPath({0, apart, 0}, {1, 0, 0}, 20), 1.0, 1.0);
  test::addModels(result);
  return result;
}

TEST(Extract, ASphereIsClosedAndHasItsVolume) {
  const Extracted made(test::sphereCase(2.0, 0.698), 0.25);
  expectClosed(made);
  EXPECT_EQ(made.eulerOfParts(), std::vector<std::ptrdiff_t>{2});
  // every vertex is within a twentieth of the radius of the field's surface
  for (std::size_t v = 0; v < made.surface.mesh.position.size(); ++v)
    ASSERT_LT(std::abs(made.field.at(made.surface.mesh.position[v], made.surface.node[v]).distance),
              0.1);
}

TEST(Extract, ATubeIsOneClosedSurfaceAtEveryFineness) {
  for (const double share : {1.0, 0.7, 0.4}) {
    const Extracted made(test::tubeCase(12), share);
    expectClosed(made);
    EXPECT_EQ(made.eulerOfParts(), std::vector<std::ptrdiff_t>{2}) << share;
    EXPECT_EQ(made.report.trees, 1U);
  }
}

TEST(Extract, ALinkClosesALoop) {
  const Extracted made(ringCase());
  expectClosed(made);
  EXPECT_EQ(made.eulerOfParts(), std::vector<std::ptrdiff_t>{0});
}

TEST(Extract, ARingWithoutItsLinkHasNoHandle) {
  formats::Case open = ringCase();
  open.tree.links.clear();
  const Extracted made(open);
  expectClosed(made);
  EXPECT_EQ(made.eulerOfParts(), std::vector<std::ptrdiff_t>{2});
}

// From apart to nearly on one another.
TEST(Extract, VesselsThatTouchOrOverlapStayTwo) {
  for (const double apart : {2.6, 2.05, 2.0, 1.6, 1.0, 0.4}) {
    const Extracted made(pairCase(apart));
    expectClosed(made);
    EXPECT_EQ(made.eulerOfParts(), (std::vector<std::ptrdiff_t>{2, 2})) << apart;
    // no vertex is shared: a triangle's cursors are all of one vessel
    for (const auto& t : made.surface.mesh.triangle) {
      const auto branch = [&](std::size_t k) {
        return made.source.tree.branch[made.surface.node[t[k]]];
      };
      ASSERT_TRUE(branch(0) == branch(1) && branch(1) == branch(2)) << apart;
    }
  }
}

// One that crosses another's axis: both stay whole.
TEST(Extract, VesselsThatCrossAreBothWhole) {
  formats::Case cross;
  cross.metadata.voxelSize = 0.2;
  test::addVessel(cross, "one", test::straightPath({-8, 0, 0}, {1, 0, 0}, 17), 1.0, 1.0);
  test::addVessel(cross, "two", test::straightPath({0, -8, 0.1}, {0, 1, 0}, 17), 0.7, 1.0);
  test::addModels(cross);
  const Extracted made(cross);
  expectClosed(made);
  EXPECT_EQ(made.eulerOfParts(), (std::vector<std::ptrdiff_t>{2, 2}));
  EXPECT_EQ(made.report.trees, 2U);
}

// A model without a lumen in the middle of a vessel: the surface is one all the same, and it is said.
TEST(Extract, AnEdgeThatTheFieldClosesIsOpened) {
  formats::Case closed = test::tubeCase(12);
  formats::BlobbyModels& models = *closed.models;
  for (std::uint32_t node = 5; node <= 7; ++node)
    for (std::uint32_t j = models.offset[node]; j < models.offset[node + 1]; ++j)
      models.width[j] *= 0.05F;
  const Extracted made(closed);
  expectClosed(made);
  EXPECT_EQ(made.eulerOfParts(), std::vector<std::ptrdiff_t>{2});
  EXPECT_GT(made.report.openedEdges, 0U);
}

TEST(Extract, TheSameCaseGivesTheSameSurface) {
  const Extracted one(pairCase(1.6)), other(pairCase(1.6));
  EXPECT_EQ(one.surface.mesh.triangle, other.surface.mesh.triangle);
  EXPECT_EQ(one.surface.mesh.position, other.surface.mesh.position);
}

// All ways to have corners of a tetrahedron inside and edges between them split: the surface is closed within a
// complex of tetrahedra around it, here one, whose boundary is the tetrahedron's faces.
TEST(MarchingTetrahedra, EdgesOfTheSurfaceWithinATetrahedronAreOfTwoTriangles) {
  for (unsigned inside = 0; inside < 16; ++inside)
    for (unsigned chosen = 0; chosen < 64; ++chosen) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
      unsigned bit = 0;
      for (std::uint32_t u = 0; u < 4; ++u)
        for (std::uint32_t v = u + 1; v < 4; ++v, ++bit)
          if ((chosen >> bit & 1U) != 0 && (inside >> u & 1U) != 0 && (inside >> v & 1U) != 0)
            edges.emplace_back(u, v);
      const convert::SplitEdges split(edges, 4);
      std::vector<convert::CrossingTriangle> triangles;
      convert::marchTetrahedron(
          {0, 1, 2, 3}, split, [&](std::uint32_t v) { return (inside >> v & 1U) != 0; }, triangles);
      std::map<std::pair<convert::Crossing, convert::Crossing>, int> directed;
      for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
      for (const auto& [edge, count] : directed) EXPECT_EQ(count, 1) << inside << " " << chosen;
    }
}

}  // namespace
}  // namespace lumen

namespace lumen::convert {
namespace {

/// The wall of a tube of 5 nodes along x at y = 0.05, z = 0.07 and radius 1 from x = 1 to x = 3, and
/// a flat outlet there with a vertex in its middle.
CaseSurface tubeSurface() {
  constexpr std::uint32_t kAround = 16;
  CaseSurface surface;
  surface.groups = {{"wall", FaceKind::Wall}, {"outlet-tube", FaceKind::Outlet}};
  for (std::uint32_t ring = 0; ring < 3; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double turn = 2 * std::numbers::pi * i / kAround;
      surface.mesh.position.emplace_back(1 + ring, 0.05 + std::cos(turn), 0.07 + std::sin(turn));
      surface.node.push_back(1 + ring);
    }
  const std::uint32_t middle = 3 * kAround;
  surface.mesh.position.emplace_back(3, 0.05, 0.07);
  surface.node.push_back(3);
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t next = (i + 1) % kAround;
    for (std::uint32_t base = 0; base < 2 * kAround; base += kAround) {
      surface.mesh.triangle.push_back({base + i, base + next, base + kAround + next});
      surface.mesh.triangle.push_back({base + i, base + kAround + next, base + kAround + i});
      surface.group.insert(surface.group.end(), 2, 0);
    }
    surface.mesh.triangle.push_back({middle, 2 * kAround + i, 2 * kAround + next});
    surface.group.push_back(1);
  }
  surface.ends = {{1, 0, 4, {3, 0.05, 0.07}, {1, 0, 0}}};
  return surface;
}

TEST(ToSurfaceMesh, KeepsFacesAndGivesVerticesWhatTheCaseSaysOfThem) {
  formats::Case source = test::tubeCase(5);
  for (std::size_t i = 0; i < 5; ++i) {
    source.tree.radius[i] = 1 + 0.01F * static_cast<float>(i);
    source.tree.inlierRate.push_back(0.1F * static_cast<float>(i));
  }
  const field::BlendedField blended = formats::caseField(source);
  const SeparatedField field(source, blended, {});
  const CaseSurface surface = tubeSurface();
  Progress progress;
  const SurfaceMesh mesh = toSurfaceMesh(surface, field, Normals::OfTriangles, progress);
  EXPECT_EQ(mesh.triangle, surface.mesh.triangle);
  EXPECT_EQ(mesh.group, surface.group);
  EXPECT_EQ(mesh.groups, surface.groups);
  EXPECT_EQ(mesh.labels, std::vector<std::string>{"tube"});
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    const Eigen::Vector3d& p = surface.mesh.position[v];
    for (int a = 0; a < 3; ++a)
      EXPECT_EQ(mesh.position[v][static_cast<std::size_t>(a)], static_cast<float>(p[a]));
    EXPECT_NEAR(mesh.radius[v], 1 + 0.01 * (p.x() - 0.03), 1e-5);
    EXPECT_NEAR(mesh.confidence[v], 0.1 * (p.x() - 0.03), 1e-5);
    EXPECT_EQ(mesh.branch[v], 0U);
    const Eigen::Vector3f normal(mesh.normal[v].data());
    const bool isWithinEnd = v + 1 == mesh.position.size();
    const Eigen::Vector3f outward(0, float(p.y()) - 0.05F, float(p.z()) - 0.07F);
    EXPECT_GT(normal.dot(isWithinEnd ? Eigen::Vector3f(1, 0, 0) : outward), 0.99);
    EXPECT_NEAR(normal.norm(), 1, 1e-5);
  }
}

}  // namespace
}  // namespace lumen::convert
