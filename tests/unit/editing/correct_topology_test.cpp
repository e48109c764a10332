// SPDX-License-Identifier: Apache-2.0
// Vessels that were found, as one vessel each: crossings, inlets and forks, on cases of beads.
#include "converters/stages/editing/correct_topology.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::kNoParent;
using formats::Vec3f;
using formats::test::addBeads;
using formats::test::alongX;

/// All is lumen; the volume is a box around the origin with faces at 20 mm.
const LumenInVolume kEverywhere{[](const Vector3d&) { return true; },
                                [](const Vector3d& p) { return p.cwiseAbs().maxCoeff() < 20; }};

/// `count` places from one on, half a millimetre apart.
std::vector<Vec3f> along(const Vector3d& from, const Vector3d& direction, int count) {
  std::vector<Vec3f> places;
  for (int i = 0; i < count; ++i) {
    const Vector3d p = from + 0.5 * i * direction.normalized();
    places.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return places;
}

Case withoutModels(Case value) {
  value.models.reset();
  return value;
}

std::string findFault(const Case& value) {
  const auto valid = formats::validate(value);
  return valid ? "" : valid.error().text();
}

std::size_t rootsOf(const Case& value) {
  const auto& branches = value.tree.branches;
  return static_cast<std::size_t>(std::count_if(
      branches.begin(), branches.end(), [](const auto& b) { return b.parentNode == kNoParent; }));
}

/// A vessel along x of a radius that a skeleton leaves on both sides along y, where a second one of
/// radius 0.8 crosses it; `after`: radius of the first behind the crossing.
Case crossing(float after) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", alongX(-10, 0.5F, 41), 1);
  addBeads(value, "up", along({0, 1.5, 0}, {0, 1, 0}, 20), 0.8F, 20);
  addBeads(value, "down", along({0, -1.5, 0}, {0, -1, 0}, 20), 0.8F, 20);
  for (std::size_t n = 21; n < 41; ++n) value.tree.radius[n] = after;
  return withoutModels(value);
}

TEST(CorrectTopology, AVesselThatCrossesAnotherIsOneOfItsOwn) {
  Case value = crossing(1);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(rootsOf(value), 2U);
  // a bridge leads across
  EXPECT_GT(value.tree.nodeCount(), 81U);
}

/// A thin vessel along another that it touches. A skeleton gets from one into the other by a slanting
/// stretch, which leaves the first far before the fork at its end.
TEST(CorrectTopology, AVesselAlongsideThatASlantReachesIsOneOfItsOwn) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", alongX(-10, 0.5F, 41), 1);
  addBeads(value, "slant", along({-3, 1, 0}, {3.5, 0.7, 0}, 7), 0.7F, 12);
  addBeads(value, "on", along({0.5, 1.7, 0}, {1, 0, 0}, 20), 0.7F, 47);
  addBeads(value, "back", along({-0.5, 1.7, 0}, {-1, 0, 0}, 20), 0.7F, 47);
  value = withoutModels(value);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(rootsOf(value), 2U);
}

TEST(CorrectTopology, AVesselThatLosesWhatItsBranchesCarryDivides) {
  // 1 - 2 x 0.63 ^ 3 = 0.5, the cube of 0.79
  Case value = crossing(0.79F);
  for (std::size_t n = 41; n < 81; ++n) value.tree.radius[n] = 0.63F;
  EXPECT_TRUE(correctTopology(value, kEverywhere).empty());
  EXPECT_EQ(rootsOf(value), 1U);
  EXPECT_EQ(value.tree.branches.size(), 3U);
}

/// A vessel that narrows evenly from 1.24 to 0.84, by as much from one side of the crossing to the
/// other as it would lose to branches of radius 0.56.
TEST(CorrectTopology, AVesselThatNarrowsEvenlyIsCrossed) {
  Case value = crossing(1);
  for (std::size_t n = 0; n < 41; ++n) value.tree.radius[n] = 1.24F - 0.01F * static_cast<float>(n);
  for (std::size_t n = 41; n < 81; ++n) value.tree.radius[n] = 0.56F;
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(rootsOf(value), 2U);
}

/// A vessel that another hides for 5 mm, beside which it goes on. Bridges lead to its parts from the
/// axis of that one, across its lumen.
TEST(CorrectTopology, ABridgeFromAParentsAxisShowsNoDirection) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", alongX(-10, 0.5F, 41), 1);
  std::vector<Vec3f> on = along({0, 0.5, 0}, {0.3, 1, 0}, 3);
  for (const Vec3f& place : along({1, 1.7, 0}, {1, 0, 0}, 20)) on.push_back(place);
  addBeads(value, "on", on, 0.7F, 20);
  addBeads(value, "before", along({-10, 1.7, 0}, {1, 0, 0}, 20), 0.7F);
  value = withoutModels(value);
  std::vector<formats::NodeOrigin> origins(value.tree.nodeCount(), formats::NodeOrigin::Measured);
  Case aside = value;  // the bridge, as if it were measured, looks aside
  correctTopology(aside, kEverywhere);
  EXPECT_EQ(rootsOf(aside), 1U);
  for (std::size_t n = 41; n < 44; ++n) origins[n] = formats::NodeOrigin::Bridged;
  formats::setNodeOrigins(value, origins);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(rootsOf(value), 2U);
}

TEST(CorrectTopology, NothingIsJoinedThroughTheBackground) {
  Case value = crossing(1);
  LumenInVolume apart = kEverywhere;
  apart.isLumen = [](const Vector3d& p) { return std::abs(p.y()) > 1.4; };
  EXPECT_TRUE(correctTopology(value, apart).empty());
}

TEST(CorrectTopology, TipsThatFaceOneAnotherAreOneVessel) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(-10, 0.5F, 17), 1);
  addBeads(value, "b", along({10, 0, 0}, {-1, 0, 0}, 17), 0.9F);
  value = withoutModels(value);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(value.tree.branches.size(), 1U);
  EXPECT_EQ(findFault(value), "");
  // directions agree with the order of nodes
  for (std::size_t n = 1; n < value.tree.nodeCount(); ++n) {
    const float step = value.tree.centre[n].x - value.tree.centre[n - 1].x;
    EXPECT_GT(step * value.tree.direction[n].x, 0) << n;
  }
}

TEST(CorrectTopology, TipsOfOtherWidthOrSideStayApart) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(-10, 0.5F, 17), 1);
  addBeads(value, "wide", along({10, 0, 0}, {-1, 0, 0}, 17), 1.6F);
  addBeads(value, "beside", along({0, 4, 0}, {0, 1, 0}, 17), 1);
  value = withoutModels(value);
  EXPECT_TRUE(correctTopology(value, kEverywhere).empty());
  EXPECT_EQ(rootsOf(value), 3U);
}

/// Two vessels of radius 1 along x, 10 mm long, whose ends face one another across a gap, and nothing is lumen.
Case aroundAVoid(double gap, int count = 21) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", along({-10 - gap / 2, 0, 0}, {1, 0, 0}, 21), 1);
  addBeads(value, "b", along({10 + gap / 2 - 0.5 * (21 - count), 0, 0}, {-1, 0, 0}, count), 1.1F);
  return withoutModels(value);
}

const LumenInVolume kDark{[](const Vector3d&) { return false; }, kEverywhere.isInside};

TEST(CorrectTopology, VesselsThatFaceOneAnotherAcrossAVoidAreOne) {
  Case value = aroundAVoid(5);
  EXPECT_EQ(correctTopology(value, kDark).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(value.tree.branches.size(), 1U);
}

TEST(CorrectTopology, ALongVoidStaysOpen) {
  Case value = aroundAVoid(6.5);  // more than three times both radii
  EXPECT_TRUE(correctTopology(value, kDark).empty());
  EXPECT_EQ(rootsOf(value), 2U);
}

TEST(CorrectTopology, NoShortPieceIsJoinedAcrossAVoid) {
  Case value = aroundAVoid(5, 11);  // 5 mm of vessel
  EXPECT_TRUE(correctTopology(value, kDark).empty());
}

TEST(CorrectTopology, AVesselOfUnsteadyWidthIsNotJoinedAcrossAVoid) {
  Case value = aroundAVoid(5);
  // radii of a track in texture: their median is that of the other side
  for (std::size_t n = 0; n < 21; ++n)
    value.tree.radius[n] = n % 3 == 0 ? 1.0F : n % 3 == 1 ? 0.6F : 1.6F;
  EXPECT_TRUE(correctTopology(value, kDark).empty());
}

TEST(CorrectTopology, AVesselBesideAVoidStaysApart) {
  Case value = aroundAVoid(4);
  for (std::size_t n = 21; n < 42; ++n) value.tree.centre[n].y = 2.5F;
  EXPECT_TRUE(correctTopology(value, kDark).empty());
}

TEST(CorrectTopology, AJoinThatClosesALoopIsALink) {
  // a ring whose two halves leave one trunk and meet on the other side
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", alongX(-18, 0.5F, 21), 1);
  for (const int side : {-1, 1}) {
    std::vector<Vec3f> half;
    for (int i = 2; i < 75; ++i) {
      const double angle = 3.05 * i / 74;
      half.push_back({static_cast<float>(-8 + 12 * (1 - std::cos(angle))),
                      static_cast<float>(side * 12 * std::sin(angle)), 0});
    }
    addBeads(value, side < 0 ? "left" : "right", half, 0.7F, 20);
  }
  value = withoutModels(value);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(value.tree.links.size(), 1U);
  EXPECT_EQ(rootsOf(value), 1U);
}

/// Adds places to those of a vessel.
void go(std::vector<Vec3f>& places, const Vector3d& from, const Vector3d& direction, int count) {
  const std::vector<Vec3f> more = along(from, direction, count);
  places.insert(places.end(), more.begin(), more.end());
}

/// A vessel of radius 1 along x, and a thinner one that comes to it from above, runs in its lumen for
/// `inside` nodes, and leaves it downward.
Case doubled(int inside) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", alongX(-10, 0.5F, 41), 1);
  std::vector<Vec3f> places;
  go(places, {-3, 8, 0}, {0, -1, 0}, 16);
  go(places, {-2.8, 0.2, 0}, {1, 0, 0}, inside);
  go(places, {-2.8 + 0.5 * inside, -0.5, 0}, {0, -1, 0}, 16);
  addBeads(value, "second", places, 0.7F);
  return withoutModels(value);
}

TEST(CorrectTopology, TwoTracksInOneLumenBecomeOne) {
  Case value = doubled(10);
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(rootsOf(value), 1U);
  ASSERT_EQ(value.tree.branches.size(), 3U) << "both parts of the second hang on the first";
  for (std::size_t b = 1; b < 3; ++b)
    EXPECT_EQ(value.tree.branch[static_cast<std::size_t>(value.tree.branches[b].parentNode)], 0U);
  // the first has 41 nodes, and the second loses those within half a radius of its axis
  EXPECT_EQ(value.tree.nodeCount(), 41U + 16 + 16 - 1);
}

TEST(CorrectTopology, LinksOfTwoTracksThatBecomeOneAreOneLink) {
  Case value = doubled(10);
  const std::uint32_t third = addBeads(value, "third", along({0, 0, 8}, {0, 0, 1}, 16), 0.5F);
  for (std::uint32_t node = 10; node < 31; ++node) value.tree.links.push_back({node, third});
  value.tree.links.push_back({41 + 16 + 5, third});  // in the middle of the common stretch
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(correctTopology(value, kEverywhere).size(), 1U);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(value.tree.links.size(), 21U);
}

TEST(CorrectTopology, AVesselThatIsBrieflyInAnotherCrossesIt) {
  Case value = doubled(2);
  EXPECT_TRUE(correctTopology(value, kEverywhere).empty());
  EXPECT_EQ(rootsOf(value), 2U);
  EXPECT_EQ(value.tree.nodeCount(), 41U + 16 + 2 + 16);
}

TEST(CorrectTopology, ATrackThatReturnsIntoItsParentsLumenClosesALoopByALink) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", alongX(-10, 0.5F, 41), 1);
  std::vector<Vec3f> places;
  go(places, {-8, 0.5, 0}, {0, 1, 0}, 14);
  go(places, {-7.5, 7, 0}, {1, 0, 0}, 20);
  go(places, {2, 6.5, 0}, {0, -1, 0}, 14);
  addBeads(value, "loop", places, 0.7F, 4);
  value = withoutModels(value);
  correctTopology(value, kEverywhere);
  EXPECT_EQ(findFault(value), "");
  EXPECT_EQ(rootsOf(value), 1U);
  EXPECT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(value.tree.links.size(), 1U);
}

TEST(CorrectTopology, ATreeBeginsAtItsWidestEndThatLeavesTheVolume) {
  Case value = formats::test::noBeads();
  // the widest end lies inside; another leaves, and is more than half as wide
  addBeads(value, "first", along({0, 0, 0}, {1, 0, 0}, 40), 1);
  for (std::size_t n = 0; n < 40; ++n)
    value.tree.radius[n] = 1.5F - 0.5F * static_cast<float>(n) / 39;
  value = withoutModels(value);
  correctTopology(value, kEverywhere);
  EXPECT_NEAR(value.tree.centre[0].x, 19.5, 1e-6);
  // where that is less than half as wide, it is an outlet
  for (std::size_t n = 0; n < 40; ++n)
    value.tree.radius[n] = 0.4F + 1.6F * static_cast<float>(n) / 39;
  correctTopology(value, kEverywhere);
  EXPECT_NEAR(value.tree.centre[0].x, 0, 1e-6);
}

TEST(CorrectTopology, TheStraightestOfLikeWidthKeepsTheBranch) {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", along({-19.5, 0, 0}, {1, 0, 0}, 30), 1);
  addBeads(value, "bent", along({-4, 1.6, 0}, {0.3, 1, 0}, 20), 0.8F, 29);
  addBeads(value, "straight", along({-4, -0.5, 0}, {1, -0.3, 0}, 20), 0.8F, 29);
  value = withoutModels(value);
  correctTopology(value, kEverywhere);
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(value.tree.branches[0].nodeCount, 50U);
  EXPECT_LT(value.tree.centre[49].y, 0);
  EXPECT_EQ(value.tree.branches[0].label, "vessel-1");
}

TEST(CorrectTopology, AneurysmsStayOnTheirNodes) {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", along({-19.5, 0, 0}, {1, 0, 0}, 30), 1);
  addBeads(value, "sac", along({-10, 2, 0}, {0, 1, 0}, 3), 1.5F, 19);
  value.tree.branches[1].kind = formats::BranchKind::Aneurysm;
  value = withoutModels(value);
  correctTopology(value, kEverywhere);
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(value.tree.branches[1].label, "aneurysm-1");
  const auto parent = static_cast<std::size_t>(value.tree.branches[1].parentNode);
  EXPECT_EQ(value.tree.centre[parent].x, -10);
}

}  // namespace
}  // namespace lumen::convert
