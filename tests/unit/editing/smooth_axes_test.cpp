// SPDX-License-Identifier: Apache-2.0
// Axes where no wall was measured, on cases of beads, and the curve that they follow.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/geometry/axis_curve.h"
#include "converters/stages/editing/correct_topology.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::NodeOrigin;
using formats::test::addBeads;
using formats::test::alongX;

/// A vessel of radius 1 along x from 0 to 20 without models.
Case trunk() {
  Case value = formats::test::noBeads();
  value.models.reset();
  addBeads(value, "trunk", alongX(0, 0.5F, 41), 1);
  return value;
}

void bridgeNodes(EditableCase& edited, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t n = first; n < end; ++n) edited.nodes[n].origin = NodeOrigin::Bridged;
}

TEST(AxisCurve, FollowsAnArcAndKeepsToALine) {
  const AxisPoint from{{1, 0, 0}, {0, 1, 0}, 2}, to{{0, 1, 0}, {-1, 0, 0}, 1};
  for (const AxisPoint& point : curveBetween(from, to, 9, std::numbers::pi / 2))
    EXPECT_NEAR(point.position.norm(), 1, 0.02);
  const AxisPoint here{{0, 0, 0}, {1, 0, 0}, 2}, there{{4, 0, 0}, {1, 0, 0}, 1};
  const std::vector<AxisPoint> line = curveBetween(here, there, 3, 100);
  ASSERT_EQ(line.size(), 3U);
  EXPECT_EQ(line[1].position, Vector3d(2, 0, 0));
  EXPECT_EQ(line[1].direction, Vector3d(1, 0, 0));
  EXPECT_EQ(line[1].radius, 1.5);
}

TEST(AxisCurve, TurnsAreThoseAtBothEnds) {
  const AxisPoint from{{0, 0, 0}, {1, 0, 0}, 1}, to{{1, 1, 0}, {0, 1, 0}, 1};
  EXPECT_NEAR(turnBetween(from, to), std::numbers::pi / 2, 1e-12);
  const AxisPoint back{{-1, 0, 0}, {-1, 0, 0}, 1};
  EXPECT_EQ(turnBetween(from, back), 0) << "the axis leads both ways";
  EXPECT_TRUE(std::isinf(turnBetween(from, from)));
}

TEST(SmoothAxes, BridgedNodesLieBetweenTheMeasuredOnes) {
  const Case value = trunk();
  EditableCase edited(value);
  bridgeNodes(edited, 10, 13);
  for (std::uint32_t n = 10; n < 13; ++n) {
    edited.nodes[n].centre.y = 0.7F;
    edited.nodes[n].radius = 0.6F;
  }
  smoothAxes(edited);
  for (std::uint32_t n = 10; n < 13; ++n) {
    EXPECT_NEAR(edited.nodes[n].centre.y, 0, 1e-6);
    EXPECT_NEAR(edited.nodes[n].centre.x, 0.5 * n, 0.1);
    EXPECT_EQ(edited.nodes[n].radius, 1);
  }
}

TEST(SmoothAxes, MeasuredNodesAndFarBridgesStay) {
  const Case value = trunk();
  EditableCase edited(value);
  edited.nodes[20].centre.y = 0.7F;
  bridgeNodes(edited, 10, 13);
  edited.nodes[11].centre.y = 1.5F;
  bridgeNodes(edited, 38, 41);  // no measured node follows
  edited.nodes[39].centre.y = 0.7F;
  smoothAxes(edited);
  EXPECT_EQ(edited.nodes[20].centre.y, 0.7F);
  EXPECT_EQ(edited.nodes[11].centre.y, 1.5F) << "farther than a radius from the curve";
  EXPECT_EQ(edited.nodes[39].centre.y, 0.7F);
}

/// A branch of radius 0.8 that leaves the trunk at 10 at an angle to x; its first node is 1.5 mm
/// from the axis, and it hangs on the node nearest to that.
Case forkOf(double degrees) {
  Case value = trunk();
  const double angle = degrees * std::numbers::pi / 180;
  std::vector<formats::Vec3f> places;
  for (double along = 1.5 / std::sin(angle); places.size() < 15; along += 0.4)
    places.push_back({static_cast<float>(10 + along * std::cos(angle)),
                      static_cast<float>(along * std::sin(angle)), 0});
  const auto nearest = static_cast<std::int32_t>(std::lround(places[0].x / 0.5F));
  addBeads(value, "branch", places, 0.8F, nearest);
  return value;
}

TEST(SmoothAxes, AnAcuteBranchLeavesBeforeTheNearestPlace) {
  const Case value = forkOf(45);
  EditableCase edited(value);
  ASSERT_EQ(edited.branches[1].parent, 23U);
  smoothAxes(edited);
  EXPECT_EQ(edited.branches[1].parent, 20U);
}

TEST(SmoothAxes, ABranchAtARightAngleLeavesAtTheNearestPlace) {
  const Case value = forkOf(90);
  EditableCase edited(value);
  smoothAxes(edited);
  EXPECT_EQ(edited.branches[1].parent, 20U);
}

TEST(SmoothAxes, BridgedNodesOfABranchLeadFromItsParentsCore) {
  Case value = trunk();
  std::vector<formats::Vec3f> places;
  for (int i = 0; i < 15; ++i) places.push_back({10.3F, 0.2F + 0.4F * static_cast<float>(i), 0.2F});
  for (std::size_t i = 3; i < places.size(); ++i) places[i].x = 10, places[i].z = 0;
  addBeads(value, "branch", places, 0.8F, 20);
  EditableCase edited(value);
  bridgeNodes(edited, 41, 45);
  smoothAxes(edited);
  ASSERT_EQ(edited.branches[1].nodes.size(), 14U) << "the first lies in the core";
  EXPECT_EQ(edited.branches[1].nodes[0], 42U);
  for (std::uint32_t n = 42; n < 45; ++n) {
    EXPECT_NEAR(edited.nodes[n].centre.x, 10, 0.1);
    EXPECT_NEAR(edited.nodes[n].centre.z, 0, 0.1);
  }
}

}  // namespace
}  // namespace lumen::convert
