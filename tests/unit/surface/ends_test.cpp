// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"
#include "closed_cases.h"
#include "converters/base/error.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/closing/cut_ends.h"
#include "converters/stages/surface/remesh/remesh_target.h"
#include "converters/stages/surface/reported_places.h"

namespace lumen::convert {
namespace {

EndsReport cut(test::ClosedCase& closed) {
  Progress silent;
  return cutEnds(closed.surface, closed.field, silent);
}

// The greatest distance of a group's vertices from the end's plane.
double unevenness(const CaseSurface& surface, const SurfaceEnd& end) {
  double most = -1;
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (surface.group[t] != end.group) continue;
    for (const std::uint32_t v : surface.mesh.triangle[t])
      most = std::max(most, std::abs(end.normal.dot(surface.mesh.position[v] - end.centre)));
  }
  return most;
}

std::vector<std::string> namesOf(const CaseSurface& surface) {
  std::vector<std::string> names;
  for (const FaceGroup& group : surface.groups) names.push_back(group.name);
  return names;
}

TEST(EndPlanes, OfATubeStandHalfAHeightBeyondItsNodes) {
  const auto planes = endPlanes(test::tubeCase(10));  // height 2 mm
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_TRUE(planes[0].isInlet);
  EXPECT_NEAR((planes[0].centre - Eigen::Vector3d(0.03 - 1, 0.05, 0.07)).norm(), 0, 1e-6);
  EXPECT_EQ(planes[0].normal, -Eigen::Vector3d::UnitX());
  EXPECT_FALSE(planes[1].isInlet);
  EXPECT_EQ(planes[1].node, 9U);
  EXPECT_NEAR((planes[1].centre - Eigen::Vector3d(9.03 + 1, 0.05, 0.07)).norm(), 0, 1e-6);
}

TEST(EndPlanes, HaveNoneWhereABranchHangsOrALinkEndsOrADomeIs) {
  formats::Case source;
  test::addVessel(source, "a", test::straightPath({0, 0, 0}, {1, 0, 0}, 5), 1, 1);
  test::addVessel(source, "b", test::straightPath({4, 1.5, 0}, {0, 1, 0}, 5), 1, 1, 4);
  test::addVessel(source, "c", test::straightPath({0, 20, 0}, {1, 0, 0}, 5), 1, 1, 2);
  test::addVessel(source, "dome", test::straightPath({0, 40, 0}, {1, 0, 0}, 5), 1, 1, 2);
  source.tree.branches[3].kind = formats::BranchKind::Aneurysm;
  source.tree.links = {{2, 14}};
  test::addModels(source);
  const auto planes = endPlanes(source);
  ASSERT_EQ(planes.size(), 2U);  // before a, behind b
  EXPECT_EQ(planes[0].branch, 0U);
  EXPECT_TRUE(planes[0].isInlet);
  EXPECT_EQ(planes[1].branch, 1U);
}

TEST(EndPlanes, MoveAlongTheCenterline) {
  formats::Case source;
  test::addVessel(source, "bent", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}}, 1, 1);
  test::addModels(source);
  const EndPlane end = endPlanes(source).at(1);
  EXPECT_NEAR((end.centre - Eigen::Vector3d(2, 2.5, 0)).norm(), 0, 1e-6);
  const auto moved = movedInward(source, end, 3.5);
  ASSERT_TRUE(moved);
  EXPECT_NEAR((moved->centre - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((moved->normal - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-6);
  EXPECT_FALSE(movedInward(source, end, 4.6));
  EXPECT_EQ(nodesNearEnd(source, end, 2), (std::vector<std::uint32_t>{2, 3, 4}));
}

TEST(CutEnds, ATubeBecomesACylinder) {
  test::ClosedCase closed(test::tubeCase(10));
  const EndsReport report = cut(closed);
  EXPECT_EQ(report.flat, 2U);
  EXPECT_EQ(report.rounded, 0U);
  test::expectClosed(closed.surface, 2);
  EXPECT_EQ(namesOf(closed.surface), (std::vector<std::string>{"wall", "inlet", "outlet-tube"}));
  ASSERT_EQ(closed.surface.ends.size(), 2U);
  for (const SurfaceEnd& end : closed.surface.ends) {
    EXPECT_GE(unevenness(closed.surface, end), 0);
    EXPECT_LT(unevenness(closed.surface, end), 1e-12);
    // the opening is as wide as the vessel or nearly so
    EXPECT_GT(test::areaOf(closed.surface, end.group), 0.64 * M_PI);
    EXPECT_LT(test::areaOf(closed.surface, end.group), 1.05 * M_PI);
  }
  for (const Eigen::Vector3d& p : closed.surface.mesh.position) {
    EXPECT_GT(p.x(), 0.03 - 1 - 1e-6);
    EXPECT_LT(p.x(), 9.03 + 1 + 1e-6);
  }
}

TEST(CutEnds, TheRimLiesOnTheField) {
  test::ClosedCase closed(test::tubeCase(10));
  cut(closed);
  for (const auto& rim : findRims(closed.surface)) {
    ASSERT_GE(rim.size(), 8U);
    for (const std::uint32_t v : rim)
      EXPECT_LT(
          std::abs(
              closed.field.at(closed.surface.mesh.position[v], closed.surface.node[v]).distance),
          1e-3);
  }
}

TEST(CutEnds, OfAForkAreThreeAndNamedByTheTree) {
  test::ClosedCase closed(test::forkCase());
  EXPECT_EQ(cut(closed).flat, 3U);
  test::expectClosed(closed.surface, 2);
  EXPECT_EQ(namesOf(closed.surface),
            (std::vector<std::string>{"wall", "inlet", "outlet-trunk", "outlet-side"}));
}

TEST(CutEnds, InletsHaveTheirLabelsWhereThereAreSeveral) {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "a", test::straightPath({0, 0, 0}, {1, 0, 0}, 8), 1.0, 1.0);
  test::addVessel(source, "b", test::straightPath({0, 9, 0}, {1, 0, 0}, 8), 1.0, 1.0);
  test::addModels(source);
  test::ClosedCase closed(std::move(source));
  EXPECT_EQ(cut(closed).flat, 4U);
  test::expectClosed(closed.surface, 4);
  EXPECT_EQ(namesOf(closed.surface),
            (std::vector<std::string>{"wall", "inlet-a", "outlet-a", "inlet-b", "outlet-b"}));
}

TEST(CutEnds, ThePlaneOfOneEndDoesNotCutTheOtherLegOfABend) {
  // A hairpin: the plane behind its last node runs through the first leg too.
  std::vector<Eigen::Vector3d> path = test::straightPath({0, 0, 0}, {1, 0, 0}, 12);
  for (int i = 1; i < 8; ++i)
    path.emplace_back(11 + 4 * std::sin(M_PI * i / 8), 4 - 4 * std::cos(M_PI * i / 8), 0);
  for (int i = 0; i < 6; ++i) path.emplace_back(11 - i, 8, 0);
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "hairpin", path, 1.0, 1.0);
  test::addModels(source);
  test::ClosedCase closed(std::move(source));
  EXPECT_EQ(cut(closed).flat, 2U);
  test::expectClosed(closed.surface, 2);
  for (const SurfaceEnd& end : closed.surface.ends)
    EXPECT_LT(test::areaOf(closed.surface, end.group), 1.05 * M_PI);
}

TEST(CutEnds, AnEndThatAnotherVesselLeavesStaysRoundAndSaysSo) {
  // The side branch leaves from within the last half radius and runs on beyond the plane.
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "trunk", test::straightPath({0, 0, 0}, {1, 0, 0}, 10), 1.0, 1.0);
  test::addVessel(source, "side", test::straightPath({8.9, 0.9, 0}, {0.5, 0.9, 0}, 9), 0.9, 1.0, 6);
  test::addModels(source);
  test::ClosedCase closed(std::move(source));
  const EndsReport report = cut(closed);
  EXPECT_EQ(report.flat, 2U);
  EXPECT_EQ(report.rounded, 1U);
  test::expectClosed(closed.surface, 2);
  ASSERT_EQ(closed.surface.groups.size(), 4U);
  EXPECT_EQ(closed.surface.groups[2], (FaceGroup{"cap-trunk", FaceKind::Cap}));
  EXPECT_GT(test::areaOf(closed.surface, 2), 0);
  ASSERT_FALSE(report.messages.empty());
  EXPECT_NE(report.messages[0].find("the end of branch \"trunk\" stays round"), std::string::npos);
}

TEST(OpenEnds, LeaveABoundaryAtEachRim) {
  test::ClosedCase closed(test::forkCase());
  cut(closed);
  std::size_t rimVertices = 0;
  for (const auto& rim : findRims(closed.surface)) rimVertices += rim.size();
  openEnds(closed.surface);
  const test::MeshFacts facts = test::measureFacts(closed.surface.mesh);
  EXPECT_EQ(facts.boundaryEdges, rimVertices);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_EQ(facts.euler, 2 - 3);
  for (const std::uint32_t group : closed.surface.group) EXPECT_EQ(group, 0U);
}

TEST(BareStretches, AWholeSurfaceHasNone) {
  const test::ClosedCase closed(test::forkCase());
  EXPECT_TRUE(stretchesWithoutWall(closed.surface, closed.source.tree).empty());
}

TEST(BareStretches, NamesTheBranchWhoseSurfaceIsNotThere) {
  test::ClosedCase closed(test::forkCase());
  CaseSurface& surface = closed.surface;
  // vertices of the side's last nodes alone are what the function looks at
  CaseSurface without = surface;
  without.mesh.position.clear();
  without.node.clear();
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    if (surface.mesh.position[v].y() > 3) continue;
    without.mesh.position.push_back(surface.mesh.position[v]);
    without.node.push_back(surface.node[v]);
  }
  const auto told = stretchesWithoutWall(without, closed.source.tree);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].find("branch side"), std::string::npos) << told[0];
}

std::string refusalOf(const ClosedSurfaceOptions& options) {
  Progress silent;
  try {
    closedSurface(test::tubeCase(20), options, silent);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "";
}

TEST(ClosedSurface, RefusesAGapWiderThanTheWidestVessel) {
  Progress silent;
  const formats::Case source = test::tubeCase(20);
  ClosedSurfaceOptions options;
  for (const double gap : {1e6, -1.0, std::nan("")}) {
    options.gap = gap;
    EXPECT_THROW(closedSurface(source, options, silent), Error) << gap;
  }
  options.gap = 2 * double{*std::max_element(source.tree.radius.begin(), source.tree.radius.end())};
  EXPECT_NO_THROW(closedSurface(source, options, silent));
}

EdgeLength inMm(double length) {
  return {0, length, length, {}};
}

ClosedSurfaceOptions withEdge(const EdgeLength& edge) {
  ClosedSurfaceOptions options;
  options.edge = edge;
  return options;
}

TEST(SurfaceSize, TinyEdgeIsRefusedWithTheNumberOfTrianglesAndOneThatIsEnough) {
  for (const double length : {1e-12, 1e-9, 1e-4}) {
    const std::string text = refusalOf(withEdge(inMm(length)));
    EXPECT_NE(text.find(" triangles, which take "), std::string::npos) << text;
    EXPECT_NE(text.find("expected at most 1.7e+07"), std::string::npos) << text;
    const std::string words = ": an edge of ";
    const auto at = text.find(words);
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NE(text.find(" mm or more"), std::string::npos) << text;
    const double enough = std::stod(text.substr(at + words.size()));
    EXPECT_GT(enough, length);
    EXPECT_NO_THROW(requireFewTriangles(test::tubeCase(20).tree, inMm(enough), {}));
  }
}

TEST(SurfaceSize, TinyShareOfTheRadiusIsRefusedWithAShareThatIsEnough) {
  const std::string text = refusalOf(withEdge({1e-6, 0, 1e9, {}}));
  EXPECT_NE(text.find("r or more"), std::string::npos) << text;
}

TEST(SurfaceSize, TinyGreatestEdgeIsRefusedInMm) {
  const std::string text = refusalOf(withEdge({0.25, 0, 1e-6, {}}));
  EXPECT_NE(text.find(" mm or more"), std::string::npos) << text;
}

TEST(SurfaceSize, WallTooThinForItsEdgesIsRefusedWithAThickerOne) {
  ClosedSurfaceOptions options;
  options.thickness = Length{1e-12, 0};
  const std::string text = refusalOf(options);
  EXPECT_NE(text.find("a thicker wall"), std::string::npos) << text;
}

TEST(SurfaceSize, ExpectsTheTrianglesThatAreMadeWithinAThird) {
  const formats::Case source = test::tubeCase(20);
  Progress silent;
  const ClosedSurface made = closedSurface(source, {}, silent);
  const double expected = expectedTriangles(source.tree, {}, {});
  EXPECT_NEAR(expected / static_cast<double>(made.report.triangles), 1, 0.33);
}

}  // namespace
}  // namespace lumen::convert
