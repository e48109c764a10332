// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/tree_profiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Adds a branch of nodes 1 mm apart along x, beginning at `from`; radius 0.25 mm.
void addBranch(formats::CenterlineTree& tree, std::int32_t parent, std::uint32_t nodes,
               formats::Vec3f from) {
  const auto first = static_cast<std::uint32_t>(tree.nodeCount());
  const auto index = static_cast<std::uint32_t>(tree.branches.size());
  for (std::uint32_t i = 0; i < nodes; ++i) {
    tree.centre.push_back({from.x + static_cast<float>(i), from.y, from.z});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(0.25F);
    tree.height.push_back(1);
    tree.parent.push_back(i == 0 ? parent : static_cast<std::int32_t>(first + i) - 1);
    tree.branch.push_back(index);
    tree.inlierRate.push_back(0.5F);
  }
  formats::Branch branch;
  branch.label = std::to_string(index);
  branch.parentNode = parent;
  branch.firstNode = first;
  branch.nodeCount = nodes;
  tree.branches.push_back(branch);
}

/// A root of five nodes that two branches leave, the second one earlier, and another root.
formats::CenterlineTree forest() {
  formats::CenterlineTree tree;
  addBranch(tree, formats::kNoParent, 5, {0, 0, 0});
  addBranch(tree, 3, 2, {3, 2, 0});
  addBranch(tree, 1, 2, {1, 2, 0});
  addBranch(tree, formats::kNoParent, 1, {0, 9, 0});
  addBranch(tree, 8, 2, {2, 4, 0});
  return tree;
}

TEST(TreeProfiles, EachBranchStandsBeforeThoseThatLeaveItInTheirOrder) {
  EXPECT_EQ(inTreeOrder(forest()), (Numbers{0, 2, 4, 1, 3}));
}

TEST(TreeProfiles, AChainOfManyBranchesNeedsNoStack) {
  formats::CenterlineTree tree;
  addBranch(tree, formats::kNoParent, 1, {0, 0, 0});
  for (std::int32_t i = 0; i < 65000; ++i) addBranch(tree, i, 1, {static_cast<float>(i), 1, 0});
  Numbers expected(65001);
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_EQ(inTreeOrder(tree), expected);
}

TEST(TreeProfiles, PlacesAreLengthsFromTheWallOfTheParent) {
  const formats::CenterlineTree tree = forest();
  const std::vector<TreeProfile> profiles = treeProfiles(tree);
  ASSERT_EQ(profiles.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(profiles[0].along.at(i), double(i), 1e-9);
  ASSERT_EQ(profiles[0].forks.size(), 2U);
  EXPECT_NEAR(profiles[0].forks[0], 1, 1e-9);
  EXPECT_NEAR(profiles[0].forks[1], 3, 1e-9);
  EXPECT_DOUBLE_EQ(profiles[1].along[0], 1.75);  // 2 mm from an axis whose vessel has 0.25 mm
  for (const TreeProfile& profile : profiles)
    EXPECT_DOUBLE_EQ(profile.along.back(),
                     formats::branchLength(tree, tree.branches[profile.branch]));
}

TEST(TreeProfiles, WithoutInlierRatesThereIsNoConfidence) {
  formats::CenterlineTree tree = forest();
  EXPECT_EQ(treeProfiles(tree)[0].confidence.size(), 5U);
  tree.inlierRate.clear();
  EXPECT_TRUE(treeProfiles(tree)[0].confidence.empty());
}

TEST(TreeProfiles, ASpikeIsDrawnHoweverManyNodesThereAre) {
  std::vector<double> along(100000);
  std::iota(along.begin(), along.end(), 0.0);
  std::vector<float> values(along.size(), 1.0F);
  values[54321] = 7;
  values[777] = 0.1F;
  const std::vector<std::size_t> drawn = drawnValues(along, values, 440);
  EXPECT_LE(drawn.size(), 4U * 441U);
  for (const std::size_t i :
       {std::size_t{0}, std::size_t{777}, std::size_t{54321}, values.size() - 1})
    EXPECT_TRUE(std::binary_search(drawn.begin(), drawn.end(), i)) << i;
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
}

TEST(TreeProfiles, OfFewValuesAllAreDrawn) {
  const std::vector<double> along = {0, 1, 2, 3};
  const std::vector<float> values = {1, 5, 2, 3};
  EXPECT_EQ(drawnValues(along, values, 440), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(drawnValues(std::vector<double>{0}, std::vector<float>{1}, 440),
            (std::vector<std::size_t>{0}));
}

TEST(TreeProfiles, ConfidenceIsSharedOutByLength) {
  formats::CenterlineTree tree;
  addBranch(tree, formats::kNoParent, 5, {0, 0, 0});
  tree.inlierRate = {0, 0.95F, 1, 0.25F, 0.25F};
  const ConfidenceShares shares = confidenceShares(tree);
  EXPECT_DOUBLE_EQ(shares.total, 4);
  EXPECT_DOUBLE_EQ(shares.length[9], 2);
  EXPECT_DOUBLE_EQ(shares.length[2], 2);
  EXPECT_DOUBLE_EQ(shares.length[0], 0);  // the first node has no edge
  EXPECT_NEAR(shares.mean, (0.95 + 1 + 0.5) / 4, 1e-7);
}

}  // namespace
}  // namespace lumen::convert
