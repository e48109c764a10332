// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/stages/fitting/image/section_fit.h"

namespace lumen::convert::fitting {
namespace {

/// A vessel of 20 nodes along x, 1 mm apart, with a branch of 20 more at its node 10.
formats::CenterlineTree forked() {
  formats::CenterlineTree tree;
  for (int i = 0; i < 20; ++i) {
    tree.centre.push_back({float(i), 0, 0});
    tree.parent.push_back(i - 1);
    tree.branch.push_back(0);
  }
  for (int i = 0; i < 20; ++i) {
    tree.centre.push_back({10, float(i + 1), 0});
    tree.parent.push_back(i == 0 ? 10 : 19 + i);
    tree.branch.push_back(1);
  }
  tree.branches.resize(2);
  tree.branches[0].label = "root";
  tree.branches[0].nodeCount = 20;
  tree.branches[1].label = "child";
  tree.branches[1].parentNode = 10;
  tree.branches[1].firstNode = tree.branches[1].nodeCount = 20;
  return tree;
}

TEST(ContrastAlong, GivesABranchTheContrastOfItsParent) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {800, 10};
  const auto expected = contrastAlong(tree, measured, 1);
  ASSERT_EQ(expected.size(), 40U);
  EXPECT_NEAR(expected[25].value, 800, 1);
  EXPECT_NEAR(expected[39].value, 800, 1);
  EXPECT_GT(expected[39].deviation, expected[25].deviation);
}

TEST(ContrastAlong, LeavesOutTheNodesOwnMeasurement) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {800, 10};
  measured[5] = {3000, 1};
  EXPECT_NEAR(contrastAlong(tree, measured, 1)[5].value, 800, 1);
}

TEST(ContrastAlong, FollowsAContrastThatFades) {
  const auto tree = forked();
  std::vector<Estimate> measured(40);
  for (std::size_t i = 0; i < 20; ++i) measured[i] = {1000 - 25.0 * double(i), 10};
  const auto expected = contrastAlong(tree, measured, 1);
  EXPECT_NEAR(expected[8].value, 800, 10);
}

TEST(ContrastAlong, IsEmptyWithoutAMeasurement) {
  EXPECT_TRUE(contrastAlong(forked(), std::vector<Estimate>(40), 1).empty());
}

}  // namespace
}  // namespace lumen::convert::fitting
