// SPDX-License-Identifier: Apache-2.0
// Nodes of one vessel that do not lead on: those that turn back, and those in the dome of its end.
#include "converters/stages/tracking/tracked_branch.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

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
