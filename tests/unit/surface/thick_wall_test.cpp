// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/thick_wall.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "closed_cases.h"
#include "converters/common/error.h"
#include "converters/mesh/self_intersections.h"

namespace lumen::convert {
namespace {

// A case's lumen and the surface `thickness` mm around it, with the same ends.
struct Walls {
  test::ClosedCase inner, outer;
  EndsReport report;

  Walls(const formats::Case& source, double thickness) : inner(source), outer(source, thickness) {
    const std::array<FieldSurface, 2> both{
        {{&inner.surface, &inner.field}, {&outer.surface, &outer.field}}};
    Progress silent;
    report = cutEnds(both, endPlanes(inner.source), silent);
  }
};

double areaOf(const CaseSurface& surface, std::uint32_t group) {
  TriangleMesh part{surface.mesh.position, {}};
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (surface.group[t] == group) part.triangle.push_back(surface.mesh.triangle[t]);
  return test::factsOf(part).area;
}

TEST(ThickWall, OfATubeIsAPipe) {
  const Walls walls(test::tubeCase(10), 0.3);
  EXPECT_EQ(walls.report.flat, 2U);
  const CaseSurface pipe = thickWall(walls.inner.surface, walls.outer.surface, walls.inner.source);
  const test::MeshFacts facts = test::factsOf(pipe.mesh);
  EXPECT_EQ(facts.euler, 0);  // a torus
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(selfIntersections(pipe.mesh).pairs.size(), 0U);
  const double outer = test::factsOf(walls.outer.surface.mesh).volume;
  const double inner = test::factsOf(walls.inner.surface.mesh).volume;
  EXPECT_NEAR(facts.volume, outer - inner, 1e-9 * outer);
  ASSERT_EQ(pipe.groups.size(), 4U);
  EXPECT_EQ(pipe.groups[0].name, "wall");
  EXPECT_EQ(pipe.groups[1].name, "outer-wall");
  EXPECT_EQ(pipe.groups[2], (FaceGroup{"inlet", FaceKind::Inlet}));
  EXPECT_EQ(pipe.groups[3], (FaceGroup{"outlet-tube", FaceKind::Outlet}));
  for (std::uint32_t e = 0; e < 2; ++e) {
    EXPECT_EQ(pipe.ends[e].group, e + 2);
    EXPECT_NEAR(areaOf(pipe, e + 2),
                areaOf(walls.outer.surface, e + 1) - areaOf(walls.inner.surface, e + 1), 1e-9);
  }
  EXPECT_GT(areaOf(pipe, 1), 1.2 * areaOf(pipe, 0));  // 1.3 times as wide
}

TEST(ThickWall, OfAForkHasAHandleForEachEndButOne) {
  const Walls walls(test::forkCase(), 0.25);
  EXPECT_EQ(walls.report.flat, 3U);
  const CaseSurface solid = thickWall(walls.inner.surface, walls.outer.surface, walls.inner.source);
  const test::MeshFacts facts = test::factsOf(solid.mesh);
  EXPECT_EQ(facts.euler, 2 + 2 - 2 * 3);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(selfIntersections(solid.mesh).pairs.size(), 0U);
}

TEST(ThickWall, ARoundEndIsClosedOnBothSides) {
  formats::Case source = test::sphereCase(1.0, 1.2);
  const Walls walls(source, 0.2);
  EXPECT_EQ(walls.report.flat, 0U);
  const CaseSurface shell = thickWall(walls.inner.surface, walls.outer.surface, walls.inner.source);
  const test::MeshFacts facts = test::factsOf(shell.mesh);
  EXPECT_EQ(facts.euler, 4);  // two spheres
  EXPECT_GT(facts.volume, 0);
  EXPECT_EQ(shell.groups.size(), 2U);
}

TEST(ThickWall, RefusesSurfacesThatMeetOrHaveOtherEnds) {
  const Walls walls(test::tubeCase(10), 0.3);
  EXPECT_THROW(thickWall(walls.outer.surface, walls.inner.surface, walls.inner.source), Error);
  CaseSurface dented = walls.outer.surface;
  for (Eigen::Vector3d& p : dented.mesh.position)
    if (std::abs(p.x() - 5) < 0.3) p.z() *= 0.5;
  EXPECT_THROW(thickWall(walls.inner.surface, dented, walls.inner.source), Error);
  CaseSurface other = walls.outer.surface;
  other.ends.pop_back();
  EXPECT_THROW(thickWall(walls.inner.surface, other, walls.inner.source), Error);
}

}  // namespace
}  // namespace lumen::convert
