// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/thick_wall.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "closed_cases.h"
#include "converters/base/error.h"
#include "converters/geometry/self_intersections.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/closing/flow_extension.h"
#include "formats/case/case_file.h"

namespace lumen::convert {
namespace {

// A case's lumen and the surface `thickness` mm around it, with the same ends.
struct Walls {
  test::ClosedCase inner;
  CaseSurface prolonged, outer;
  EndsReport report;

  Walls(const formats::Case& source, double thickness) : inner(source) {
    Progress silent;
    report = cutEnds(inner.surface, inner.field, silent);
    prolonged = inner.surface;
    extendEnds(prolonged, inner.source, {{"", {thickness, 1}}});
    const OffsetField around(inner.source, inner.blended, 0.02, prolonged, {thickness, 0});
    ExtractionReport found;
    outer = extractSurface(around, 0.5, found, silent);
    cutLike(outer, around, inner.surface, silent);
  }
};

TEST(ThickWall, OfATubeIsAPipe) {
  const Walls walls(test::tubeCase(10), 0.3);
  EXPECT_EQ(walls.report.flat, 2U);
  const CaseSurface pipe = thickWall(walls.inner.surface, walls.outer);
  const test::MeshFacts facts = test::measureFacts(pipe.mesh);
  EXPECT_EQ(facts.euler, 0);  // a torus
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(selfIntersections(pipe.mesh).pairs.size(), 0U);
  const double outer = test::measureFacts(walls.outer.mesh).volume;
  const double inner = test::measureFacts(walls.inner.surface.mesh).volume;
  EXPECT_NEAR(facts.volume, outer - inner, 1e-9 * outer);
  ASSERT_EQ(pipe.groups.size(), 4U);
  EXPECT_EQ(pipe.groups[0].name, "wall");
  EXPECT_EQ(pipe.groups[1].name, "outer-wall");
  EXPECT_EQ(pipe.groups[2], (FaceGroup{"inlet", FaceKind::Inlet}));
  EXPECT_EQ(pipe.groups[3], (FaceGroup{"outlet-tube", FaceKind::Outlet}));
  for (std::uint32_t e = 0; e < 2; ++e) {
    EXPECT_EQ(pipe.ends[e].group, e + 2);
    EXPECT_NEAR(test::areaOf(pipe, e + 2),
                test::areaOf(walls.outer, e + 1) - test::areaOf(walls.inner.surface, e + 1), 1e-9);
  }
  EXPECT_GT(test::areaOf(pipe, 1), 1.2 * test::areaOf(pipe, 0));  // 1.3 times as wide
}

TEST(ThickWall, OfAForkHasAHandleForEachEndButOne) {
  const Walls walls(test::forkCase(), 0.25);
  EXPECT_EQ(walls.report.flat, 3U);
  const CaseSurface solid = thickWall(walls.inner.surface, walls.outer);
  const test::MeshFacts facts = test::measureFacts(solid.mesh);
  EXPECT_EQ(facts.euler, 2 + 2 - 2 * 3);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(selfIntersections(solid.mesh).pairs.size(), 0U);
}

TEST(ThickWall, ARoundEndIsClosedOnBothSides) {
  formats::Case source = test::sphereCase(1.0, 1.2);
  const Walls walls(source, 0.2);
  EXPECT_EQ(walls.report.flat, 0U);
  const CaseSurface shell = thickWall(walls.inner.surface, walls.outer);
  const test::MeshFacts facts = test::measureFacts(shell.mesh);
  EXPECT_EQ(facts.euler, 4);  // two spheres
  EXPECT_GT(facts.volume, 0);
  EXPECT_EQ(shell.groups.size(), 2U);
}

TEST(ThickWall, RefusesSurfacesWithOtherEnds) {
  const Walls walls(test::tubeCase(10), 0.3);
  EXPECT_THROW(thickWall(walls.outer, walls.inner.surface), Error);
  CaseSurface other = walls.outer;
  other.ends.pop_back();
  EXPECT_THROW(thickWall(walls.inner.surface, other), Error);
}

TEST(ThickWall, AnOuterSurfaceThatMeetsTheLumenIsLiftedOutOfIt) {
  const Walls walls(test::tubeCase(10), 0.3);
  CaseSurface dented = walls.outer;
  for (Eigen::Vector3d& p : dented.mesh.position)
    if (std::abs(p.x() - 5) < 0.3) p.z() *= 0.7;
  const auto crossings = [&] {
    return selfIntersections(thickWall(walls.inner.surface, dented).mesh).pairs.size();
  };
  EXPECT_GT(crossings(), 0U);
  const OffsetField around(walls.inner.source, walls.inner.blended, 0.02, walls.prolonged,
                           {0.3, 0});
  Progress silent;
  liftOuter(walls.inner.surface, dented, around, silent);
  EXPECT_EQ(crossings(), 0U);
}

TriangleMesh meshOf(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  for (const Float3& p : surface.position) mesh.position.emplace_back(p[0], p[1], p[2]);
  mesh.triangle = surface.triangle;
  return mesh;
}

// The distances from the lumen's side at corners and in the middles of the outer wall's triangles, as
// shares of what was asked, ascending.
std::vector<double> thicknesses(const SurfaceMesh& solid, double asked) {
  const TriangleMesh mesh = meshOf(solid);
  TriangleMesh inner{mesh.position, {}};
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    if (solid.group[t] == 0) inner.triangle.push_back(mesh.triangle[t]);
  const TriangleTree tree(inner);
  std::vector<double> shares;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (solid.group[t] != 1) continue;
    const auto &a = mesh.position[mesh.triangle[t][0]], &b = mesh.position[mesh.triangle[t][1]],
               &c = mesh.position[mesh.triangle[t][2]];
    for (const Eigen::Vector3d& p : {a, Eigen::Vector3d((a + b + c) / 3)})
      shares.push_back(tree.nearest(p).distance / asked);
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

double at(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Stages in their order, and the units of the current one.
class Stages : public Progress {
public:
  void begin(std::string_view stage, std::size_t total) override {
    names.emplace_back(stage);
    m_left = total;
  }
  void advance(std::size_t units) override { m_left -= units; }
  void end() override { areAllDone = areAllDone && m_left == 0; }

  std::vector<std::string> names;
  bool areAllDone = true;

private:
  std::atomic<std::size_t> m_left{0};
};

ClosedSurface makeWall(const formats::Case& source, const Length& thickness) {
  ClosedSurfaceOptions options;
  options.thickness = thickness;
  Progress silent;
  return closedSurface(source, options, silent);
}

void expectSolid(const SurfaceMesh& solid, std::ptrdiff_t euler) {
  const test::MeshFacts facts = test::measureFacts(meshOf(solid));
  EXPECT_EQ(facts.euler, euler);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_GT(facts.volume, 0);
  EXPECT_EQ(selfIntersections(meshOf(solid), 5).pairs.size(), 0U);
}

TEST(ThickWall, EachOfItsLongStagesReportsProgress) {
  ClosedSurfaceOptions options;
  options.thickness = Length{0.3, 0};
  Stages stages;
  closedSurface(test::forkCase(), options, stages);
  const std::vector<std::string> both = {
      "cells",     "lattice", "topology",  "extracting", "remeshing",
      "crossings", "cells",   "lattice",   "topology",   "extracting",
      "remeshing", "seams",   "crossings", "crossings",  "measuring the wall"};
  EXPECT_EQ(stages.names, both);
  EXPECT_TRUE(stages.areAllDone);
}

TEST(ThickWall, IsAsThickAsWasAskedInTheCornerOfAForkToo) {
  for (const double thickness : {0.1, 0.5, 1.5}) {
    const ClosedSurface made = makeWall(test::forkCase(), {thickness, 0});
    expectSolid(made.levels[0], 2 + 2 - 2 * 3);
    const auto shares = thicknesses(made.levels[0], thickness);
    EXPECT_NEAR(at(shares, 0.5), 1, 0.02) << thickness;
    EXPECT_GT(at(shares, 0.01), 0.95) << thickness;
    EXPECT_LT(at(shares, 0.99), 1.05) << thickness;
    EXPECT_TRUE(made.report.messages.empty());
  }
}

TEST(ThickWall, GoesWithCoarserLevelsAndABoundOfTheirError) {
  ClosedSurfaceOptions options;
  options.thickness = Length{0.4, 0};
  options.maxError = SurfaceError{.mm = 0.05};
  options.levels = 3;
  Progress silent;
  const ClosedSurface made = closedSurface(test::forkCase(), options, silent);
  ASSERT_EQ(made.levels.size(), 3U);
  EXPECT_LE(made.report.errors[0], 0.05);
  for (const SurfaceMesh& level : made.levels) expectSolid(level, 2 + 2 - 2 * 3);
}

TEST(ThickWall, GoesWithNeitherOpenEndsNorExtensions) {
  ClosedSurfaceOptions options;
  options.thickness = Length{0.4, 0};
  Progress silent;
  ClosedSurfaceOptions open = options, extended = options;
  open.open = true;
  extended.extend = {{"", {1, 0}}};
  EXPECT_THROW(closedSurface(test::forkCase(), open, silent), Error);
  EXPECT_THROW(closedSurface(test::forkCase(), extended, silent), Error);
}

formats::Case twoVessels(const Eigen::Vector3d& start, const Eigen::Vector3d& along) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "left", test::straightPath({0, 0, 0}, {1, 0, 0}, 12), 1.0, 1.0);
  test::addVessel(source, "right", test::straightPath(start, along, 12), 1.0, 1.0);
  test::addModels(source);
  return source;
}

// Two tubes without a common root that pass each other at a right angle, each of radius 1 mm.
formats::Case crossing(double distance) {
  return twoVessels({5.5, -5.5, distance}, {0, 1, 0});
}

// Two tubes that run side by side: 2.3 mm apart.
TEST(ThickWall, IsThinnerWhereVesselsKeepApartAndSaysSo) {
  ClosedSurfaceOptions options;
  options.thickness = Length{0.5, 0};
  options.touching = Touching::Apart;
  Progress silent;
  const ClosedSurface made = closedSurface(twoVessels({0, 2.3, 0}, {1, 0, 0}), options, silent);
  expectSolid(made.levels[0], 0 + 0);
  const auto shares = thicknesses(made.levels[0], 0.5);
  EXPECT_NEAR(at(shares, 0.5), 1, 0.02);
  EXPECT_LT(shares.front(), 0.4);
  ASSERT_EQ(made.report.messages.size(), 1U);
  EXPECT_NE(made.report.messages[0].find("left"), std::string::npos);
  EXPECT_NE(made.report.messages[0].find("right"), std::string::npos);
}

// One outer surface, a sphere with four ends, and two lumens.
TEST(ThickWall, IsOneWhereVesselsShareIt) {
  const ClosedSurface made = makeWall(crossing(2.3), {0.5, 0});
  expectSolid(made.levels[0], 2 + 2 + 2 - 2 * 4);
  ASSERT_TRUE(made.report.wall.has_value());
  EXPECT_EQ(made.report.crossings, 0U);
  EXPECT_NEAR(made.report.wall->least, 0.3, 0.04);  // 2.3 less both radii
  EXPECT_NEAR(made.report.wall->median, 0.5, 0.01);
  const auto& histogram = made.report.wall->histogram;
  std::size_t counted = 0;
  for (const std::size_t bin : histogram) counted += bin;
  EXPECT_EQ(counted, made.report.wall->measured);
  EXPECT_GT(histogram[5] + histogram[6] + histogram[7], 0U);
  EXPECT_EQ(histogram[0] + histogram[1] + histogram[2] + histogram[3] + histogram[4], 0U);
  ASSERT_EQ(made.report.messages.size(), 1U);
  EXPECT_NE(made.report.messages[0].find("left and right share"), std::string::npos);
}

// Lumens that overlap by a third of a radius are drawn apart, so that a wall is left between them.
TEST(ThickWall, IsClosedAroundLumensThatOverlap) {
  for (const Touching touching : {Touching::Share, Touching::Apart}) {
    ClosedSurfaceOptions options;
    options.thickness = Length{0.4, 0};
    options.touching = touching;
    Progress silent;
    const ClosedSurface made = closedSurface(crossing(1.7), options, silent);
    expectSolid(made.levels[0], touching == Touching::Share ? -2 : 0);
    EXPECT_EQ(made.report.crossings, 0U);
    EXPECT_GT(made.report.wall->least, touching == Touching::Share ? 0.15 : 0.05);
  }
}

}  // namespace
}  // namespace lumen::convert
