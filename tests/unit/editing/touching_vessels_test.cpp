// SPDX-License-Identifier: Apache-2.0
// Vessels that were found, where tracks overlap, end before another's side or only touch one another.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/stages/editing/correct_topology.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::Vec3f;
using formats::test::addBeads;

const LumenInVolume kLumen{[](const Vector3d&) { return true; },
                           [](const Vector3d& p) { return p.cwiseAbs().maxCoeff() < 30; }};

/// Places half a millimetre apart from one point to another.
std::vector<Vec3f> between(const Vector3d& from, const Vector3d& to) {
  std::vector<Vec3f> places;
  const int steps = static_cast<int>(std::lround((to - from).norm() / 0.5));
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = from + static_cast<double>(i) / steps * (to - from);
    places.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return places;
}

/// Places along a line with corners.
std::vector<Vec3f> through(const std::vector<Vector3d>& corners) {
  std::vector<Vec3f> places;
  for (std::size_t i = 1; i < corners.size(); ++i)
    for (const Vec3f& p : between(corners[i - 1], corners[i]))
      if (places.empty() || p != places.back()) places.push_back(p);
  return places;
}

void finish(Case& value) {
  value.models.reset();
  const auto valid = formats::validate(value);
  ASSERT_TRUE(valid) << valid.error().text();
}

/// Two tracks of one vessel along x that have 4 mm in common, the second one beside the first.
Case overlapping(double beside) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", between({-10, 0, 0}, {2, 0, 0}), 1);
  addBeads(value, "b", between({10, beside, 0}, {-2, beside, 0}), 0.9F);
  finish(value);
  return value;
}

TEST(TouchingVessels, TracksThatEnteredOneStretchFromBothSidesAreOneVessel) {
  Case value = overlapping(0.2);
  EXPECT_EQ(correctTopology(value, kLumen).size(), 1U);
  finish(value);
  ASSERT_EQ(value.tree.branches.size(), 1U);
  const float way = value.tree.centre.back().x - value.tree.centre.front().x;
  for (std::size_t n = 1; n < value.tree.nodeCount(); ++n)
    EXPECT_GT(way * (value.tree.centre[n].x - value.tree.centre[n - 1].x), 0) << n;
}

TEST(TouchingVessels, TheStretchWithMoreMeasuredNodesStays) {
  for (const bool isFirst : {true, false}) {
    Case value = overlapping(0.2);
    std::vector<formats::NodeOrigin> origins(value.tree.nodeCount(), formats::NodeOrigin::Measured);
    // nodes of the common stretch of the other one
    for (std::size_t n = 0; n < 9; ++n)
      origins[isFirst ? value.tree.nodeCount() - 1 - n : 24 - n] = formats::NodeOrigin::Bridged;
    formats::setNodeOrigins(value, origins);
    correctTopology(value, kLumen);
    for (const Vec3f& p : value.tree.centre) {
      const float kept = isFirst ? 0 : 0.2F;
      const bool isInMiddle = std::abs(p.x) < 1.1F;
      EXPECT_TRUE(!isInMiddle || std::abs(p.y - kept) < 1e-6F) << p.x << ' ' << p.y;
    }
  }
}

TEST(TouchingVessels, TracksBesideOneAnotherStayApart) {
  Case value = overlapping(1.8);
  EXPECT_TRUE(correctTopology(value, kLumen).empty());
  EXPECT_EQ(value.tree.branches.size(), 2U);
}

TEST(TouchingVessels, TipsOfOtherWidthOrDirectionInOnePlaceStayApart) {
  Case wide = overlapping(0.2);
  for (std::size_t n = 25; n < wide.tree.nodeCount(); ++n) wide.tree.radius[n] = 1.6F;
  correctTopology(wide, kLumen);
  EXPECT_EQ(wide.tree.branches.size(), 2U);  // not one vessel
  Case across = formats::test::noBeads();
  addBeads(across, "a", between({-10, 0, 0}, {2, 0, 0}), 1);
  addBeads(across, "b", between({1.7, 12, 0}, {1.7, -0.3, 0}), 0.9F);
  finish(across);
  EXPECT_TRUE(correctTopology(across, kLumen).empty());
}

TEST(TouchingVessels, AStretchThatABranchLeavesStays) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", between({-10, 0, 0}, {2, 0, 0}), 1);
  addBeads(value, "branch", between({-0.5, 1.2, 0}, {-4, 9, 0}), 0.5F, 19);
  addBeads(value, "b", between({10, 0.2, 0}, {-2, 0.2, 0}), 0.9F);
  finish(value);
  correctTopology(value, kLumen);
  finish(value);
  const auto& nodes = value.tree.centre;
  EXPECT_NE(std::find(nodes.begin(), nodes.end(), Vec3f{-0.5F, 0, 0}), nodes.end());
}

TEST(TouchingVessels, ATipWithAnAneurysmStays) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", between({-10, 0, 0}, {2, 0, 0}), 1);
  addBeads(value, "sac", between({2, 1.5, 0}, {2, 3, 0}), 1.2F, 24);
  value.tree.branches[1].kind = formats::BranchKind::Aneurysm;
  addBeads(value, "b", between({10, 0.2, 0}, {-2, 0.2, 0}), 0.9F);
  finish(value);
  correctTopology(value, kLumen);
  finish(value);
  const auto sac = std::find_if(
      value.tree.branches.begin(), value.tree.branches.end(),
      [](const formats::Branch& b) { return b.kind == formats::BranchKind::Aneurysm; });
  ASSERT_NE(sac, value.tree.branches.end());
  ASSERT_GE(sac->parentNode, 0);
  const Vec3f parent = value.tree.centre[static_cast<std::size_t>(sac->parentNode)];
  EXPECT_EQ(parent, (Vec3f{2, 0, 0}));
}

/// A vessel that bends where a straight one, which a skeleton leaves on both sides, touches it at a
/// `distance` from its axis.
Case bentBesideStraight(double distance) {
  Case value = formats::test::noBeads();
  addBeads(value, "bent", through({{-20, 3, 0}, {0, 0, 0}, {20, 3, 0}}), 1);
  const std::vector<Vec3f>& axis = value.tree.centre;
  const auto nodeAt = [&](float x) {
    return static_cast<std::int32_t>(
        std::find_if(axis.begin(), axis.end(), [&](const Vec3f& p) { return p.x >= x; }) -
        axis.begin());
  };
  const std::int32_t left = nodeAt(-2.5F), right = nodeAt(2.5F);
  addBeads(value, "left", between({-2.5, -distance, 0}, {-15, -distance, 0}), 0.8F, left);
  addBeads(value, "right", between({2.5, -distance, 0}, {15, -distance, 0}), 0.8F, right);
  finish(value);
  return value;
}

TEST(TouchingVessels, AVesselThatABentOneHidesIsOneOfItsOwn) {
  const LumenInVolume bend{[](const Vector3d& p) { return std::abs(p.x()) > 1.5 || p.y() > -0.3; },
                           kLumen.isInside};
  Case value = bentBesideStraight(0.9);
  EXPECT_EQ(correctTopology(value, bend).size(), 1U);
  finish(value);
  EXPECT_EQ(value.tree.branches.size(), 2U);
  Case apart = bentBesideStraight(2.6);
  EXPECT_TRUE(correctTopology(apart, bend).empty());
  const LumenInVolume walled{[](const Vector3d& p) { return p.y() > -0.1 || p.y() < -0.5; },
                             kLumen.isInside};
  Case behind = bentBesideStraight(0.9);  // a wall lies between both ends and the bent one
  EXPECT_TRUE(correctTopology(
                  behind, {[&](const Vector3d& p) { return bend.isLumen(p) && walled.isLumen(p); },
                           kLumen.isInside})
                  .empty());
}

/// A trunk along x, and a vessel that leaves it, goes round and comes back to 2.5 mm before its axis.
Case comingBack(double end) {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", between({-20, 0, 0}, {20, 0, 0}), 1.2F);
  std::vector<Vec3f> round = between({-10, 1.5, 0}, {-10, 12, 0});
  for (const Vec3f& p : between({-9.5, 12, 0}, {9.5, 12, 0})) round.push_back(p);
  for (const Vec3f& p : between({10, 12, 0}, {10, end, 0})) round.push_back(p);
  addBeads(value, "round", round, 0.7F, 20);
  finish(value);
  return value;
}

TEST(TouchingVessels, AVesselThatEndsJustBeforeAnothersSideIsLinkedToIt) {
  Case value = comingBack(2.5);
  EXPECT_EQ(correctTopology(value, kLumen).size(), 1U);
  finish(value);
  ASSERT_EQ(value.tree.links.size(), 1U);
  const auto [a, b] = value.tree.links[0];
  for (const std::uint32_t node : {a, b}) EXPECT_NEAR(value.tree.centre[node].x, 10, 1);
  EXPECT_NEAR(std::min(value.tree.centre[a].y, value.tree.centre[b].y), 0, 1e-6);
}

TEST(TouchingVessels, AVesselThatEndsFarFromAnotherOrBehindAWallIsNot) {
  Case far = comingBack(5);
  EXPECT_TRUE(correctTopology(far, kLumen).empty());
  Case walled = comingBack(2.5);
  EXPECT_TRUE(correctTopology(walled, {[](const Vector3d& p) { return p.y() < 1.2 || p.y() > 1.8; },
                                       kLumen.isInside})
                  .empty());
}

TEST(TouchingVessels, AnEndIsNotLinkedToTheForkThatItHangsOn) {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", between({-20, 0, 0}, {20, 0, 0}), 1.2F);
  std::vector<Vec3f> hook = between({-4, 1.5, 0}, {-4, 3.5, 0});
  for (const Vec3f& p : between({-3.5, 4, 0}, {-1, 4, 0})) hook.push_back(p);
  for (const Vec3f& p : between({-0.5, 3.5, 0}, {-0.5, 2, 0})) hook.push_back(p);
  addBeads(value, "hook", hook, 0.6F, 32);
  finish(value);
  EXPECT_TRUE(correctTopology(value, kLumen).empty());
}

TEST(TouchingVessels, ALooseVesselThatEndsJustBeforeAnothersSideIsItsBranch) {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", between({-20, 0, 0}, {20, 0, 0}), 1.2F);
  addBeads(value, "loose", between({3, 2.5, 0}, {3, 15, 0}), 0.7F);
  finish(value);
  EXPECT_EQ(correctTopology(value, kLumen).size(), 1U);
  finish(value);
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_GE(value.tree.branches[1].parentNode, 0);
  EXPECT_TRUE(value.tree.links.empty());
}

/// A vessel along x, and a second one that leaves it far behind, turns back to pass at a distance,
/// and turns once more there. A false connection leads a skeleton from the first into the second
/// there, too, and on and back to a place that the second one's track has reached.
Case ladder(double distance) {
  Case value = formats::test::noBeads();
  addBeads(value, "first", between({-25, 0, 0}, {25, 0, 0}), 1);
  const double y = distance;
  addBeads(value, "before",
           through({{-22, 1.5, 0}, {-20, y, 4}, {-20, y, 17}, {-10.5, y, 17.3}, {-5, y, 7.8}}),
           0.8F, 4);
  addBeads(value, "on", between({0, y, 0}, {20, y, 0}), 0.8F, 50);
  addBeads(value, "back", between({-0.25, y, 0.43}, {-5.5, y, 8.7}), 0.8F,
           static_cast<std::int32_t>(value.tree.branches[2].firstNode));
  finish(value);
  return value;
}

TEST(TouchingVessels, ALoopIsCutWhereVesselsTouch) {
  Case value = ladder(1.9);
  EXPECT_EQ(correctTopology(value, kLumen).size(), 1U);
  finish(value);
  EXPECT_TRUE(value.tree.links.empty());
  ASSERT_EQ(value.tree.branches.size(), 2U);
  // the second one hangs on its own fork alone
  EXPECT_LT(value.tree.centre[static_cast<std::size_t>(value.tree.branches[1].parentNode)].x, -20);
}

TEST(TouchingVessels, NoLoopIsCutWhereAnAneurysmHangs) {
  Case value = ladder(1.9);
  addBeads(value, "sac", between({0, -1.5, 0}, {0, -3, 0}), 1.2F, 50);
  value.tree.branches.back().kind = formats::BranchKind::Aneurysm;
  finish(value);
  correctTopology(value, kLumen);
  finish(value);
  EXPECT_EQ(value.tree.links.size(), 1U);
  EXPECT_GE(value.tree.branches.back().parentNode, 0);
}

TEST(TouchingVessels, AVesselThatConnectsTwoOthersIsKept) {
  Case value = ladder(4);
  EXPECT_EQ(correctTopology(value, kLumen).size(), 1U);
  finish(value);
  EXPECT_EQ(value.tree.links.size(), 1U);
  EXPECT_EQ(value.tree.branches.size(), 4U);
}

}  // namespace
}  // namespace lumen::convert
