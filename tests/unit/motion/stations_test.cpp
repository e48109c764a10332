// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "converters/stages/motion/search.h"
#include "trees.h"

namespace lumen::convert {
namespace {

bool isStation(const Stations& s, std::uint32_t node) {
  return std::find(s.node.begin(), s.node.end(), node) != s.node.end();
}

TEST(MotionStations, AreRootsTipsForksAndNodesARadiusApart) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Stations s = placeStations(tree);
  for (const std::uint32_t node : {0U, 12U, 16U, 20U, 31U, 42U})
    EXPECT_TRUE(isStation(s, node)) << node;
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_LT(s.parent[i], static_cast<std::int32_t>(i));
    EXPECT_LE(s.gap[i], 2.0 + 1e-6) << i;  // two radii and less than two nodes
  }
  EXPECT_EQ(std::count(s.parent.begin(), s.parent.end(), -1), 1);
  EXPECT_LT(s.size(), tree.nodeCount());
  const auto tip = std::find(s.node.begin(), s.node.end(), 20U) - s.node.begin();
  EXPECT_GE(s.gap[static_cast<std::size_t>(tip)], 1.0);
}

TEST(MotionStations, StandForTheWholeLength) {
  const Stations s = placeStations(test::forkedTree());
  // 20 edges of the trunk, 11 of each arm with the one to its parent
  const double first = std::hypot(0.5, 0.0), second = std::hypot(0.5, 0.0);
  EXPECT_NEAR(std::accumulate(s.length.begin(), s.length.end(), 0.0),
              10.0 + 5.0 + first + 5.0 + second, 1e-5);
}

TEST(MotionStations, SpreadsMovesLinearlyAlongTheTree) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Stations s = placeStations(tree);
  // a linear move along z comes back on the trunk; a constant one everywhere
  std::vector<Eigen::Vector3d> moves;
  for (const std::uint32_t node : s.node)
    moves.emplace_back(0.1 * double{tree.centre[node].z}, 2, 0);
  const std::vector<Eigen::Vector3d> all = s.spread(moves);
  ASSERT_EQ(all.size(), tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    EXPECT_NEAR(all[i].x(), 0.1 * double{tree.centre[i].z}, 1e-6) << i;
    EXPECT_NEAR(all[i].y(), 2, 1e-12);
  }
}

TEST(MotionStations, KnowWhereTheTreeEnds) {
  const Stations s = placeStations(test::forkedTree());
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::uint32_t node = s.node[i];
    EXPECT_EQ(s.end[i], node == 0 ? -1 : node == 20 || node == 31 || node == 42 ? 1 : 0) << node;
  }
}

TEST(MotionStations, ABranchOfOneNodeIsAStation) {
  formats::CenterlineTree tree = test::forkedTree();
  test::addBranch(tree, 5, {0, 0, 2.5}, {0.3, 0, 0}, 1, 0.3F);
  const Stations s = placeStations(tree);
  EXPECT_TRUE(isStation(s, 43));
  EXPECT_TRUE(isStation(s, 5));
}

}  // namespace
}  // namespace lumen::convert
