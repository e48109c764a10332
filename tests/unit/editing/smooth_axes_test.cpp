// SPDX-License-Identifier: Apache-2.0
// Axes where no wall was measured, on cases of beads, and the curve that they follow.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/vectors.h"
#include "converters/geometry/axis_curve.h"
#include "converters/stages/editing/correct_topology.h"
#include "converters/stages/editing/trim.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"
#include "unit/formats/sample_case.h"

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

// Ends that are too thin or too short, on a case of beads along x, half a millimetre apart.
using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// "a" has nodes 0 to 20 of radius 1 from x = 0 to 10. "b" leaves its node 10 and has 6 nodes of
/// radius 0.5, the last two 0.2. "c" hangs on the last node of "b", 4 nodes of radius 0.2. "d"
/// leaves node 18 of "a", 12 nodes of radius 0.8, so that 1 mm of "a" lies behind it.
Case makeTree() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 21), 1);
  addBeads(value, "b", alongX(5.5F, 0.5F, 6, 2), 1, 10);
  addBeads(value, "c", alongX(8.5F, 0.5F, 4, 2), 1, 26);
  addBeads(value, "d", alongX(9.5F, 0.5F, 12, 3), 1, 18);
  const auto set = [&](std::uint32_t first, std::uint32_t count, float radius) {
    for (std::uint32_t n = first; n < first + count; ++n) value.tree.radius[n] = radius;
  };
  set(0, 21, 1);
  set(21, 4, 0.5F);
  set(25, 6, 0.2F);
  set(31, 12, 0.8F);
  return value;
}

std::vector<std::string> sizes(const Case& value) {
  std::vector<std::string> all;
  for (const auto& branch : value.tree.branches)
    all.push_back(branch.label + " " + std::to_string(branch.nodeCount));
  return all;
}

using Sizes = std::vector<std::string>;

}  // namespace

TEST(Trim, RemovesThinEndsUpToTheFirstNodeThatIsWideEnough) {
  Case value = makeTree();
  const TrimResult trimmed = trimEnds(value, {0.3, 0});
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 4", "d 12"}));
  EXPECT_TRUE(formats::validate(value));
  ASSERT_EQ(trimmed.ends.size(), 2U);
  EXPECT_EQ(trimmed.ends[0].label, "b");
  EXPECT_FALSE(trimmed.ends[0].isWhole);
  EXPECT_EQ(trimmed.ends[0].nodes, 2U);
  EXPECT_NEAR(trimmed.ends[0].length, 1, 1e-6);
  EXPECT_NEAR(trimmed.ends[0].radius, 0.2, 1e-6);
  EXPECT_EQ(trimmed.ends[1].label, "c");
  EXPECT_TRUE(trimmed.ends[1].isWhole);
}

TEST(Trim, RemovesShortEndsBehindTheLastBranchAndWholeBranches) {
  Case value = makeTree();
  trimEnds(value, {0, 1.9});
  // 1 mm of "a" lies behind "d", all of it within the ball there; "c" is 1.8 mm long outside of "b"
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "b 6", "d 12"}));
  trimEnds(value, {0, 4});
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "d 12"}));
}

TEST(Trim, AnEndThatIsShortOnceItsThinPartIsGoneGoesToo) {
  Case value = makeTree();
  trimEnds(value, {0.3, 3});
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "d 12"}));
}

TEST(Trim, KeepsBranchesThatLeadToALink) {
  Case value = makeTree();
  value.tree.links = {{2, 30}};
  EXPECT_TRUE(trimEnds(value, {0.3, 0}).ends.empty());
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 6", "c 4", "d 12"}));
}

TEST(Trim, KeepsAneurysmsAndTheVesselThatTheyHangOn) {
  Case value = makeTree();
  value.tree.branches[2].kind = formats::BranchKind::Aneurysm;
  EXPECT_TRUE(trimEnds(value, {0.3, 0}).ends.empty());
}

TEST(Trim, ATreeOfOneThinVesselGoes) {
  Case value = makeTree();
  const auto first = static_cast<std::uint32_t>(value.tree.nodeCount());
  addBeads(value, "loose", alongX(0, 0.5F, 9, 20), 1);
  for (std::uint32_t n = first; n < first + 9; ++n) value.tree.radius[n] = 0.25F;
  trimEnds(value, {0.3, 0});
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 4", "d 12"}));
}

TEST(Trim, RefusesLimitsThatLeaveNothing) {
  Case value = makeTree();
  EXPECT_THROW(trimEnds(value, {2, 0}), Error);
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 6", "c 4", "d 12"}));
}

TEST(Trim, RecordsAnEditUnlessNothingGoes) {
  Case value = makeTree();
  EXPECT_TRUE(trimEnds(value, {0.1, 0}).ends.empty());
  EXPECT_EQ(lastStep(value.metadata, kEditStep), nullptr);
  const TrimResult trimmed = trimEnds(value, {0.3, 1.9});
  EXPECT_EQ(trimmed.change.sentence, "trimmed 3 ends thinner than 0.3 mm or shorter than 1.9 mm");
  EXPECT_NE(lastStep(value.metadata, kEditStep), nullptr);
}

}  // namespace lumen::convert
