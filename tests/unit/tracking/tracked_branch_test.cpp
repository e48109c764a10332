// SPDX-License-Identifier: Apache-2.0
// Nodes of one vessel that do not lead on: those that turn back, and those in the dome of its end.
#include "converters/stages/tracking/tracked_branch.h"

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
