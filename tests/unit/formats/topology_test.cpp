// SPDX-License-Identifier: Apache-2.0
#include "formats/case/topology.h"

#include <gtest/gtest.h>

#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using Nodes = std::vector<std::uint32_t>;

// 0 - 1 - 2 - 5, and 1 - 3 - 4.
CenterlineTree tree() {
  return test::richCase().tree;
}

Nodes neighboursOf(const CenterlineTree& of, std::uint32_t node) {
  const Neighbours neighbours(of);
  const auto found = neighbours.of(node);
  return {found.begin(), found.end()};
}

TEST(Neighbours, AreParentAndChildrenInAscendingOrder) {
  EXPECT_EQ(neighboursOf(tree(), 0), (Nodes{1}));
  EXPECT_EQ(neighboursOf(tree(), 1), (Nodes{0, 2, 3}));
  EXPECT_EQ(neighboursOf(tree(), 4), (Nodes{3}));
  EXPECT_EQ(neighboursOf(tree(), 5), (Nodes{2}));
}

TEST(Neighbours, DoNotLinkTheTreesOfAForest) {
  CenterlineTree forest = tree();
  forest.parent[3] = kNoParent;
  EXPECT_EQ(neighboursOf(forest, 1), (Nodes{0, 2}));
  EXPECT_EQ(neighboursOf(forest, 3), (Nodes{4}));
}

TEST(Neighbours, WithinADistanceCrossBranchesNearestFirst) {
  const Neighbours neighbours(tree());
  EXPECT_EQ(neighbours.within(4, 0), (Nodes{4}));
  EXPECT_EQ(neighbours.within(4, 1), (Nodes{4, 3}));
  EXPECT_EQ(neighbours.within(4, 2), (Nodes{4, 3, 1}));
  EXPECT_EQ(neighbours.within(1, 2), (Nodes{1, 0, 2, 3, 5, 4}));
  EXPECT_EQ(neighbours.within(4, 100), (Nodes{4, 3, 1, 0, 2, 5}));
}

// spec: M5
TEST(Neighbours, AreJoinedByLinksToo) {
  CenterlineTree linked = tree();
  const auto count = static_cast<std::uint32_t>(linked.nodeCount());
  linked.links = {{0, count - 1}};
  const Neighbours neighbours(linked);
  EXPECT_EQ(neighbours.of(0).back(), count - 1);
  EXPECT_EQ(neighbours.of(count - 1).front(), 0u);
}

TEST(Neighbours, WithinADistanceAreFoundOnceAroundALoop) {
  CenterlineTree ring;
  ring.centre.resize(4);
  ring.parent = {-1, 0, 1, 2};
  ring.links = {{0, 3}};
  EXPECT_EQ(Neighbours(ring).within(0, 9), (std::vector<std::uint32_t>{0, 1, 3, 2}));
}

TEST(Neighbours, OfASingleNodeAreNone) {
  const Neighbours neighbours(test::smallestCase().tree);
  EXPECT_TRUE(neighbours.of(0).empty());
  EXPECT_EQ(neighbours.within(0, 5), (Nodes{0}));
}

TEST(BranchLength, OfARootIsItsPolyline) {
  EXPECT_DOUBLE_EQ(branchLength(tree(), tree().branches[0]), 2.5);
}

TEST(BranchLength, CountsTheLinkBeyondTheParentsRadius) {
  CenterlineTree t = tree();
  t.centre[3] = {0, 3, 1};  // 3 mm from node 1, whose radius is 2 mm; then 1 mm to node 4
  t.centre[4] = {0, 4, 1};
  EXPECT_DOUBLE_EQ(branchLength(t, t.branches[1]), 2.0);
}

TEST(BranchLength, CountsNoLinkThatEndsInsideTheParent) {
  CenterlineTree t = tree();
  t.centre[3] = {0, 1, 1};
  t.centre[4] = {0, 4, 1};
  EXPECT_DOUBLE_EQ(branchLength(t, t.branches[1]), 3.0);
}

}  // namespace
}  // namespace lumen::formats
