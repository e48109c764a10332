// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/repetition.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/unit/compare/lines.h"

namespace lumen::convert {
namespace {

using formats::Case;

/// A trunk of 20 mm, and beside it a branch of `length` mm if that is above 0.
Case trunkAnd(double length) {
  Case value;
  addLine(value, "trunk", {0, 0, 0}, {20, 0, 0}, 1);
  if (length > 0) addLine(value, "branch", {10, 5, 0}, {10, 5 + length, 0}, 1);
  return value;
}

TEST(CompareRuns, OfEqualRunsFindAllAgain) {
  const Case judged = trunkAnd(10);
  const Repetition found = compareRuns(judged, std::array{judged, judged});
  EXPECT_EQ(found.runs, 2U);
  EXPECT_EQ(found.spread(), 0);
  EXPECT_EQ(found.branches, (std::vector<float>{1, 1}));
  EXPECT_TRUE(found.unstable.empty());
}

TEST(CompareRuns, StateWhatSomeLack) {
  const Case judged = trunkAnd(10);
  const Repetition found =
      compareRuns(judged, std::array{judged, trunkAnd(0), Case{}, trunkAnd(10)});
  EXPECT_DOUBLE_EQ(found.leastLength, 0);  // the run that finds nothing
  EXPECT_NEAR(found.greatestLength, 30, 1e-4);
  EXPECT_EQ(found.spread(), 1);
  EXPECT_FLOAT_EQ(found.branches[0], 0.75F);
  EXPECT_FLOAT_EQ(found.branches[1], 0.5F);
  ASSERT_EQ(found.unstable.size(), 2U);
  EXPECT_EQ(found.unstable[0].label, "trunk");
  EXPECT_EQ(found.unstable[0].runs, 1U);
  EXPECT_EQ(found.unstable[1].label, "branch");
  EXPECT_EQ(found.unstable[1].runs, 2U);
  EXPECT_NEAR(found.unstable[1].length, 10, 1e-4);
}

TEST(CompareRuns, StateWhatTheJudgedCaseLacksButNotShortVessels) {
  const Repetition found = compareRuns(trunkAnd(0), std::array{trunkAnd(10), trunkAnd(4)});
  EXPECT_FLOAT_EQ(found.branches[0], 1);
  ASSERT_EQ(found.unstable.size(), 1U);
  EXPECT_EQ(found.unstable[0].label, "");
  EXPECT_NEAR(found.unstable[0].length, 10, 1e-4);
  EXPECT_NEAR(found.spread(), 1.0 / 3, 1e-6);
}

TEST(CompareRuns, FindANodeInTheLumenAndNotBesideIt) {
  Case aside;
  addLine(aside, "trunk", {0, 0.9, 0}, {20, 0.9, 0}, 1);
  Case apart;
  addLine(apart, "trunk", {0, 1.1, 0}, {20, 1.1, 0}, 1);
  EXPECT_FLOAT_EQ(compareRuns(trunkAnd(0), std::array{aside}).branches[0], 1);
  EXPECT_FLOAT_EQ(compareRuns(trunkAnd(0), std::array{apart}).branches[0], 0);
}

}  // namespace
}  // namespace lumen::convert
