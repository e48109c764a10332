// SPDX-License-Identifier: Apache-2.0
// Ends of tracks and the place where a child is joined to its parent (docs/method.md, sections 1.5 and
// 1.12), one step below trackFromSeeds().
#include "converters/stages/tracking/track_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/joining.h"
#include "converters/stages/tracking/path_rules.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using formats::StopReason;

/// A volume with all that a track in it needs.
struct Tracked {
  explicit Tracked(Volume theVolume, TrackOptions theOptions = {})
      : volume(std::move(theVolume)), options(theOptions) {}

  Volume volume;
  BsplineVolume spline{volume};
  TrackOptions options;
  Progress silent;
  TrackContext context{spline, options, 0, silent};
  TrackRun run{context, Random(1)};
};

TrackedNode steadyNodeAt(const Vector3d& centre, const Vector3d& direction, double radius) {
  TrackedNode node;
  node.centre = centre;
  node.direction = direction;
  node.radius = node.height = radius;
  node.inlierRate = 0.9;
  return node;
}

/// Nodes from a place on, 0.4 mm apart.
TrackedBranch lineOfNodes(const Vector3d& from, const Vector3d& direction, int count,
                          double radius) {
  TrackedBranch branch;
  for (int i = 0; i < count; ++i)
    branch.nodes.push_back(steadyNodeAt(from + 0.4 * i * direction, direction, radius));
  return branch;
}

/// A track along z from a place on the axis of a volume's vessel.
TrackedBranch trackUp(Tracked& tracked, const Vector3d& from, double radius,
                      FinishedBranches finished = {}) {
  TrackedBranch branch = lineOfNodes(from, Vector3d::UnitZ(), 3, radius);
  trackToEnd(tracked.run, branch, finished);
  return branch;
}

/// A tube of radius 0.6 along z that widens into a round end, a ball of radius 1.1.
Volume roundedWideningTip() {
  return drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, 8}, 0.6),
                    (p - Vector3d(6.4, 6.4, 8.4)).norm() - 1.1);
  });
}

TEST(TrackToEnd, ALostVesselGivesUpTheWideNodesOfItsRoundTip) {
  Tracked tracked(roundedWideningTip());
  const TrackedBranch branch = trackUp(tracked, {6.4, 6.4, 3}, 0.6);
  EXPECT_EQ(branch.stopReason, StopReason::NoValidCylinder);
  EXPECT_LT(branch.nodes.back().radius, 1.4 * 0.6);
}

TEST(TrackToEnd, AVesselThatLeavesTheVolumeKeepsItsWideTip) {
  Tracked tracked(drawVolume(64, 0.2, [](const Vector3d& p) {
    const double part = std::clamp((p.z() - 9.4) / 2.0, 0.0, 1.0);
    return std::hypot(p.x() - 6.4, p.y() - 6.4) - (0.7 + 0.6 * part);
  }));
  const TrackedBranch branch = trackUp(tracked, {6.4, 6.4, 3}, 0.7);
  EXPECT_EQ(branch.stopReason, StopReason::LeftVolume);
  EXPECT_GT(branch.nodes.back().radius, 1.4 * 0.7);
}

TEST(TrackToEnd, StopsAtTheBoundOnNodes) {
  TrackOptions options;
  options.maxNodes = 7;
  Tracked tracked(straightTube(0.8), options);
  const TrackedBranch branch = trackUp(tracked, {6.4, 6.4, 3}, 0.8);
  EXPECT_EQ(branch.stopReason, StopReason::StepLimit);
  EXPECT_EQ(branch.nodes.size(), 7u);
}

TEST(TrackToEnd, StopsBeforeTheCoreOfAFinishedBranch) {
  Tracked tracked(tee(1.0));
  const TrackedBranch across = lineOfNodes({6.4, 6.4, 1}, Vector3d::UnitZ(), 28, 1.2);
  const TrackedBranch* const finished = &across;
  TrackedBranch branch = lineOfNodes({11.4, 6.4, 6.4}, -Vector3d::UnitX(), 3, 1.0);
  trackToEnd(tracked.run, branch, {&finished, 1});
  EXPECT_EQ(branch.stopReason, StopReason::MetBranch);
  EXPECT_GT(branch.nodes.back().centre.x(), 6.4 + 0.5 * 1.2);
}

TEST(TrackToEnd, ATrackThatComesBackIntoItselfHasTurnedBack) {
  // a ring, along which nothing but the track itself ends it
  constexpr double kRing = 3.5;
  Tracked tracked(drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::hypot(std::hypot(p.x() - 6.4, p.y() - 6.4) - kRing, p.z() - 6.4) - 0.7;
  }));
  TrackedBranch branch = lineOfNodes({6.4 + kRing, 6.4, 6.4}, Vector3d::UnitY(), 1, 0.7);
  trackToEnd(tracked.run, branch, {});
  EXPECT_EQ(branch.stopReason, StopReason::TurnedBack);
}

TEST(DropTip, DropsAtMostThreeNodesThatAreMuchWiderThanThoseBefore) {
  TrackedBranch branch = lineOfNodes({0, 0, 0}, Vector3d::UnitZ(), 20, 1.0);
  for (int i = 0; i < 2; ++i)
    branch.nodes.push_back(steadyNodeAt({0, 0, 8.0 + 0.4 * i}, Vector3d::UnitZ(), 2.0));
  dropTip(branch.nodes);
  EXPECT_EQ(branch.nodes.size(), 20u);
  for (int i = 0; i < 6; ++i)
    branch.nodes.push_back(
        steadyNodeAt({0, 0, 8.0 + 0.4 * i}, Vector3d::UnitZ(), 2.0 * std::pow(2, i)));
  dropTip(branch.nodes);
  EXPECT_EQ(branch.nodes.size(), 23u);
}

TEST(DropTip, KeepsNodesThatAreAsWideAsThoseBefore) {
  TrackedBranch branch = lineOfNodes({0, 0, 0}, Vector3d::UnitZ(), 20, 1.0);
  branch.nodes.back().radius = 1.3;
  dropTip(branch.nodes);
  EXPECT_EQ(branch.nodes.size(), 20u);
}

TEST(JoinToParent, AfterACutInTheCoreTheParentIsTheNodeNearestToTheFirstThatIsKept) {
  Tracked tracked(tee(0.6));
  const TrackedBranch parent = lineOfNodes({6.4, 6.4, 2}, Vector3d::UnitZ(), 22, 1.2);
  // the child runs in its parent's core from z = 4 to the fork, and leaves it there
  TrackedBranch child = lineOfNodes({6.4, 6.4, 4}, Vector3d::UnitZ(), 6, 0.6);
  const TrackedBranch arm = lineOfNodes({6.8, 6.4, 6.4}, Vector3d::UnitX(), 12, 0.6);
  child.nodes.insert(child.nodes.end(), arm.nodes.begin(), arm.nodes.end());
  child.parentBranch = 0;
  joinToParent(tracked.run, {&parent, 1}, {}, child);
  ASSERT_EQ(child.parentBranch, 0);
  const Vector3d first = child.nodes.front().centre;
  EXPECT_GT(first.x(), 6.4 + 0.5 * 1.2);
  EXPECT_EQ(child.parentNode, static_cast<int>(closestOnChain(parent.nodes, first).node));
}

// The tip of a vessel that ends is dropped where it widens, as nothing holds it; that of one that leaves the volume stays.
/// A tube of radius 0.8 mm along z, which widens from `from` on by `slope`.
Volume flaredTube(double from, double slope) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) {
    const double radius = 0.8 + slope * std::max(0.0, p.z() - from);
    const double across = std::hypot(p.x() - 6.4, p.y() - 6.4) - radius;
    return std::max(across, 0.4 - p.z());
  });
}

}  // namespace

TEST(Tip, ThatWidensIsDroppedWhereTheVesselEnds) {
  for (const double slope : {0.6, 1.0, 2.0}) {
    const auto tree = trackOne(flaredTube(9, slope), {seedAt("tube", {6.4, 6.4, 4.0})}).result.tree;
    ASSERT_EQ(tree.branches.size(), 1U);
    EXPECT_EQ(tree.branches[0].stopReason, formats::StopReason::NoValidCylinder);
    EXPECT_GT(tree.centre.back().z, 8.0F);
    EXPECT_LT(tree.radius.back(), 1.12F) << slope;
  }
}

TEST(Tip, ThatWidensStaysWhereTheVesselLeavesTheVolume) {
  const auto tree = trackOne(flaredTube(11, 0.6), {seedAt("tube", {6.4, 6.4, 4.0})}).result.tree;
  ASSERT_EQ(tree.branches.size(), 1U);
  EXPECT_EQ(tree.branches[0].stopReason, formats::StopReason::LeftVolume);
  EXPECT_GT(tree.radius.back(), 1.12F);  // 1.4 times the radius before
}

namespace {

// Nodes of one vessel that do not lead on: those that turn back, and those in the dome of its end.
TrackedNode nodeAt(double x, double radius, double inlierRate, double direction = 1) {
  TrackedNode node;
  node.centre = {x, 0, 0};
  node.direction = {direction, 0, 0};
  node.radius = radius;
  node.inlierRate = inlierRate;
  return node;
}

std::vector<double> placesOf(const TrackedBranch& branch) {
  std::vector<double> places;
  for (const TrackedNode& node : branch.nodes) places.push_back(node.centre.x());
  return places;
}

TEST(TrackedBranch, OfTwoNodesInTheWrongOrderTheBetterStays) {
  TrackedBranch branch;
  branch.nodes = {nodeAt(0, 1, 0.8), nodeAt(2, 1, 0.4), nodeAt(1, 1, 0.9), nodeAt(3, 1, 0.8),
                  nodeAt(2.5, 1, 0.5)};
  branch.clickNode = 3;
  dropTurnedBack(branch);
  EXPECT_EQ(placesOf(branch), (std::vector<double>{0, 1, 3}));
  EXPECT_EQ(branch.clickNode, 2U);
}

TEST(TrackedBranch, ANodeThatPointsBackTurnsBack) {
  TrackedBranch branch;
  branch.nodes = {nodeAt(0, 1, 0.8), nodeAt(1, 1, 0.8), nodeAt(2, 1, 0.5, -1)};
  dropTurnedBack(branch);
  EXPECT_EQ(placesOf(branch), (std::vector<double>{0, 1}));
}

/// Nodes along half of a circle, of a rate of 0.8, of which one points across the vessel and has a
/// rate of 1.
std::vector<TrackedNode> bendWithOneAcross(std::size_t count, std::size_t across) {
  std::vector<TrackedNode> nodes;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(count - 1);
    TrackedNode node = nodeAt(0, 1, i == across ? 1.0 : 0.8);
    node.centre = 10 * Eigen::Vector3d(std::sin(angle), 1 - std::cos(angle), 0);
    node.direction = {std::cos(angle), std::sin(angle), 0};
    if (i == across) node.direction = {-std::sin(angle + 0.2), std::cos(angle + 0.2), 0};
    nodes.push_back(node);
  }
  return nodes;
}

TEST(TrackedBranch, OneNodeAcrossABendCostsNoOther) {
  constexpr std::size_t kCount = 60, kAcross = 5;
  const std::vector<TrackedNode> nodes = bendWithOneAcross(kCount, kAcross);
  std::vector<const TrackedNode*> all;
  for (const TrackedNode& node : nodes) all.push_back(&node);
  const std::vector<bool> isBack = turnedBack(all);
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(isBack[i], i == kAcross) << i;
}

TEST(TrackedBranch, NodesThatHaveSlidTogetherAreOne) {
  TrackedBranch branch;
  branch.nodes = {nodeAt(0, 1, 0.4), nodeAt(0.1, 1, 0.6), nodeAt(0.5, 1, 0.6),
                  nodeAt(1, 1, 0.5), nodeAt(1.2, 1, 0.5), nodeAt(1.24, 1, 0.9)};
  branch.clickNode = 5;
  dropCrowded(branch);
  EXPECT_EQ(placesOf(branch), (std::vector<double>{0.1, 0.5, 1.24}));
  EXPECT_EQ(branch.clickNode, 2U);
}

TEST(TrackedBranch, ADomeIsCutAndATaperStays) {
  TrackedBranch dome;
  dome.nodes = {nodeAt(0, 1, 1), nodeAt(0.5, 1, 1), nodeAt(1, 0.7, 1), nodeAt(1.3, 0.5, 1)};
  dropDome(dome);
  EXPECT_EQ(placesOf(dome), (std::vector<double>{0, 0.5, 1}));
  TrackedBranch taper;
  for (int i = 0; i < 10; ++i) taper.nodes.push_back(nodeAt(0.5 * i, 1 - 0.05 * i, 1));
  dropDome(taper);
  EXPECT_EQ(taper.nodes.size(), 10U);
}

}  // namespace
}  // namespace lumen::convert
