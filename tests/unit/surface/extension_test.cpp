// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "closed_cases.h"
#include "converters/base/error.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/closing/flow_extension.h"

namespace lumen::convert {
namespace {

void cutAll(test::ClosedCase& closed) {
  Progress silent;
  cutEnds(closed.surface, closed.field, silent);
}

TEST(ExtendEnds, AddsTubesOfTheOpeningsArea) {
  test::ClosedCase closed(test::forkCase());
  cutAll(closed);
  const double before = test::measureFacts(closed.surface.mesh).volume;
  std::vector<SurfaceEnd> ends = closed.surface.ends;
  double added = 0;
  std::vector<double> area;
  for (const SurfaceEnd& end : ends) {
    area.push_back(test::areaOf(closed.surface, end.group));
    added += area.back() * 5 * std::sqrt(area.back() / M_PI);
  }
  EXPECT_TRUE(extendEnds(closed.surface, closed.source, {{"", {0, 5}}}).empty());
  test::expectClosed(closed.surface, 2);
  // the blend may be a little wider or narrower than the tube
  EXPECT_NEAR(test::measureFacts(closed.surface.mesh).volume, before + added, 0.05 * added);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const SurfaceEnd& end = closed.surface.ends[e];
    EXPECT_EQ(end.group, ends[e].group);
    EXPECT_NEAR((end.centre - ends[e].centre).norm(), 5 * std::sqrt(area[e] / M_PI), 1e-9);
    // a regular polygon in the circle of the opening's area
    EXPECT_NEAR(test::areaOf(closed.surface, end.group), area[e], 0.03 * area[e]);
    EXPECT_GT(test::areaOf(closed.surface, end.group), 0);
  }
}

TEST(ExtendEnds, TheTubesEndIsACircleInAPlane) {
  test::ClosedCase closed(test::tubeCase(10));
  cutAll(closed);
  extendEnds(closed.surface, closed.source, {{"tube", {4, 0}}});
  const auto rims = findRims(closed.surface);
  ASSERT_EQ(rims.size(), 2U);
  for (std::size_t e = 0; e < 2; ++e) {
    const SurfaceEnd& end = closed.surface.ends[e];
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : rims[e])
      middle += closed.surface.mesh.position[v] / double(rims[e].size());
    const double radius = (closed.surface.mesh.position[rims[e][0]] - middle).norm();
    for (const std::uint32_t v : rims[e]) {
      const Eigen::Vector3d p = closed.surface.mesh.position[v];
      EXPECT_NEAR(end.normal.dot(p - end.centre), 0, 1e-9);
      EXPECT_NEAR((p - middle).norm(), radius, 1e-9);
    }
  }
}

TEST(ExtendEnds, LeavesAlongTheWallsTangent) {
  // At the rim the tube's triangles turn by little more than the wall's do at the row before.
  test::ClosedCase closed(test::tubeCase(10));
  cutAll(closed);
  const auto rims = findRims(closed.surface);
  std::vector<Eigen::Vector3d> at;
  for (std::size_t i = 0; i < rims[1].size(); ++i)
    at.push_back(closed.surface.mesh.position[rims[1][i]]);
  extendEnds(closed.surface, closed.source, {{"", {0, 3}}});
  // mean normal of the wall's side and of the tube's side of the rim, weighted by area
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double wall = 0, tube = 0;
  int walls = 0, tubes = 0;
  for (const Triangle& t : closed.surface.mesh.triangle) {
    const auto& p = closed.surface.mesh.position;
    int on = 0;
    for (const std::uint32_t v : t)
      for (const Eigen::Vector3d& q : at) on += p[v] == q ? 1 : 0;
    if (on < 2) continue;
    const Eigen::Vector3d normal = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
    const Eigen::Vector3d middle = (p[t[0]] + p[t[1]] + p[t[2]]) / 3;
    const double tilt = std::asin(normal.dot(axis)) * 180 / M_PI;
    (middle.x() > at[0].x() ? tube : wall) += tilt;
    ++(middle.x() > at[0].x() ? tubes : walls);
  }
  ASSERT_GT(walls, 7);
  ASSERT_GT(tubes, 7);
  EXPECT_GT(wall / walls, 3);  // the field narrows the vessel at its end, which a tube must follow
  EXPECT_NEAR(tube / tubes, wall / walls, 5);
}

TEST(ExtendEnds, TrianglesAreNearlyEquilateral) {
  test::ClosedCase closed(test::tubeCase(10));
  cutAll(closed);
  const std::size_t before = closed.surface.mesh.triangle.size();
  extendEnds(closed.surface, closed.source, {{"tube", {0, 5}}});
  std::vector<double> angles;
  const auto& p = closed.surface.mesh.position;
  const double end = closed.surface.ends[1].centre.x();
  for (const Triangle& t : closed.surface.mesh.triangle) {
    const double x = (p[t[0]] + p[t[1]] + p[t[2]]).x() / 3;
    if (x < end - 3 || x > end - 1e-6) continue;  // the straight part
    double least = 180;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = p[t[(i + 1) % 3]] - p[t[i]], b = p[t[(i + 2) % 3]] - p[t[i]];
      least = std::min(least, std::acos(a.dot(b) / a.norm() / b.norm()) * 180 / M_PI);
    }
    angles.push_back(least);
  }
  ASSERT_GT(angles.size(), 100U);
  EXPECT_GT(*std::min_element(angles.begin(), angles.end()), 50);
  EXPECT_GT(closed.surface.mesh.triangle.size(), before);
}

TEST(ExtendEnds, OneBranchOnly) {
  test::ClosedCase closed(test::forkCase());
  cutAll(closed);
  const std::vector<SurfaceEnd> ends = closed.surface.ends;
  extendEnds(closed.surface, closed.source, {{"side", {3, 0}}});
  EXPECT_EQ(closed.surface.ends[0].centre, ends[0].centre);
  EXPECT_EQ(closed.surface.ends[1].centre, ends[1].centre);
  EXPECT_NEAR((closed.surface.ends[2].centre - ends[2].centre).norm(), 3, 1e-9);
}

// Two vessels, of which the last node of one points at the other.
formats::Case pointingCase() {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  test::addVessel(source, "one", test::straightPath({0, 0, 0}, {1, 0, 0}, 12), 1.0, 1.0);
  test::addVessel(source, "two", test::straightPath({6, 12, 0}, {0, -1, 0}, 7), 1.0, 1.0);
  test::addModels(source);
  return source;
}

TEST(ExtendEnds, SaysWhatATubeRunsInto) {
  test::ClosedCase closed(pointingCase());
  cutAll(closed);
  const auto messages = extendEnds(closed.surface, closed.source, {{"two", {0, 7}}});
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0],
            "the extension of outlet-two runs into branch one; expected a shorter extend there");
}

TEST(ExtendFreeEnds, LeavesTheEndWhoseTubeWouldRunIntoAnotherVessel) {
  test::ClosedCase closed(pointingCase());
  cutAll(closed);
  const std::vector<SurfaceEnd> before = closed.surface.ends;
  ASSERT_EQ(before.size(), 4U);
  extendFreeEnds(closed.surface, closed.source, {0, 7});
  test::expectClosed(closed.surface, 4);
  for (std::size_t e = 0; e < before.size(); ++e) {
    const SurfaceEnd& end = closed.surface.ends[e];
    const bool isStuck = closed.surface.groups[end.group].name == "outlet-two";
    const double moved = (end.centre - before[e].centre).norm();
    if (isStuck)
      EXPECT_EQ(moved, 0);
    else
      EXPECT_GT(moved, 6);
  }
}

TEST(ExtendEnds, RefusesUnknownLabelsAndTwoLengthsAndTooMuch) {
  test::ClosedCase closed(test::tubeCase(10));
  cutAll(closed);
  EXPECT_THROW(extendEnds(closed.surface, closed.source, {{"tub", {0, 5}}}), Error);
  EXPECT_THROW(extendEnds(closed.surface, closed.source, {{"", {0, 5}}, {"", {1, 0}}}), Error);
  EXPECT_THROW(extendEnds(closed.surface, closed.source, {{"", {1e12, 0}}}), Error);
}

}  // namespace
}  // namespace lumen::convert
