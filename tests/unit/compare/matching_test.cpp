// SPDX-License-Identifier: Apache-2.0
// Which found branch answers for which true one. The truth is a T: a root of 20 mm and radius 1
// along x, and a child of 10 mm and radius 0.5 that leaves it upwards at x = 10.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/judge/compare/compare.h"
#include "converters/judge/compare/repetition.h"
#include "lines.h"
#include "tests/unit/compare/lines.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;

formats::Case teeTruth() {
  formats::Case truth = straightTruth();
  addLine(truth, "b01", {10, 0, 0}, {10, 10, 0}, 0.5, 20);
  return truth;
}

TEST(Matching, AChildThatIsTrackedFromOutsideItsParentIsWhole) {
  // as the tracker leaves it: first node 1.25 parent radii from the axis, tied to a node a little
  // upstream
  formats::Case found = straightTruth();
  addLine(found, "b01", {10, 1.25, 0}, {10, 10, 0}, 0.5, 19);
  const Comparison result = compared(found, teeTruth());
  EXPECT_EQ(result.score.overlap, 1);
  EXPECT_EQ(result.score.missed, 0);
  EXPECT_EQ(result.score.falseLength, 0);
  EXPECT_EQ(result.branches[1].label, "b01");
  EXPECT_EQ(result.branches[1].score.overlap, 1);
  EXPECT_NEAR(result.branches[1].score.radiusBias, 0, 1e-6);
}

TEST(Matching, ThePartOfAChildInsideItsParentIsNotMissed) {
  const Comparison result = compared(straightTruth(), teeTruth());
  EXPECT_NEAR(result.branches[1].score.missed, 9, 0.11);
  EXPECT_EQ(result.branches[1].score.overlap, 0);
  EXPECT_NEAR(result.score.overlap, 40 / (40 + 9.0), 0.005);
}

TEST(Matching, LabelsNeedNotAgree) {
  formats::Case found;
  addLine(found, "stem", {0, 0, 0}, {20, 0, 0}, 1);
  addLine(found, "side", {10, 1.25, 0}, {10, 10, 0}, 0.5, 20);
  const Comparison result = compared(found, teeTruth());
  EXPECT_EQ(result.score.overlap, 1);
  EXPECT_EQ(result.score.falseLength, 0);
}

TEST(Matching, AVesselFoundInTwoPiecesIsWhole) {
  formats::Case found;
  addLine(found, "late", {20, 0, 0}, {10.1, 0, 0}, 1);
  addLine(found, "early", {0, 0, 0}, {10, 0, 0}, 1);
  const Comparison result = compared(found, straightTruth());
  EXPECT_EQ(result.score.overlap, 1);
  EXPECT_NEAR(result.score.averageInside, 0, 0.01);
}

TEST(Matching, ASecondCopyOfAVesselIsFalse) {
  formats::Case found = teeTruth();
  addLine(found, "again", {2, 0.2, 0}, {8, 0.2, 0}, 1);
  const Comparison result = compared(found, teeTruth());
  EXPECT_NEAR(result.score.falseLength, 6, 0.11);
  EXPECT_EQ(result.branches[0].score.falseLength, 0);
  EXPECT_NEAR(result.score.overlap, (40 + 18) / (40 + 18 + 6.0), 0.005);
}

TEST(Matching, ASecondCopyIsFalseWithoutLabelsToo) {
  formats::Case found;
  addLine(found, "one", {0, 0, 0}, {20, 0, 0}, 1);
  addLine(found, "two", {5, 0.2, 0}, {15, 0.2, 0}, 1);
  EXPECT_NEAR(compared(found, straightTruth()).score.falseLength, 10, 0.11);
}

TEST(Matching, AWrongTurnIntoAVesselThatNobodyElseFoundAnswersForIt) {
  // "root" turns into the child; its own second half is missed
  formats::Case found;
  addLine(found, "root", {0, 0, 0}, {10, 0, 0}, 1);
  addLine(found, "tail", {10, 0.5, 0}, {10, 10, 0}, 0.5);
  found.tree.branches[0].nodeCount += found.tree.branches[1].nodeCount;
  found.tree.branches.pop_back();
  for (std::uint32_t& branch : found.tree.branch) branch = 0;
  const Comparison result = compared(found, teeTruth());
  // both go on matching for about a radius past the parting
  EXPECT_NEAR(result.branches[0].score.missed, 9, 0.11);
  EXPECT_NEAR(result.branches[0].score.falseLength, 9, 0.5);
  EXPECT_NEAR(result.branches[1].score.overlap, 1, 0.01);
  EXPECT_EQ(result.score.falseLength, 0);
}

TEST(Matching, AChildThatTracksItsParentAgainIsFalse) {
  formats::Case found = straightTruth();
  addLine(found, "b01", {11.25, 0, 0}, {20, 0, 0}, 1, 20);
  const Comparison result = compared(found, teeTruth());
  EXPECT_EQ(result.branches[1].score.overlap, 0);
  // 10 mm from the parent node, less what a link and the child's way through its parent may take: 1
  // + 2
  EXPECT_NEAR(result.score.falseLength, 10 - 3, 0.21);
}

TEST(Matching, ABranchOutsideEveryVesselIsFalse) {
  formats::Case found = teeTruth();
  addLine(found, "stray", {0, -5, 0}, {6, -5, 0}, 0.5);
  EXPECT_NEAR(compared(found, teeTruth()).score.falseLength, 6, 0.11);
}

TEST(Matching, AneurysmsAreScoredButLeftOutOfTheWhole) {
  formats::Case truth = straightTruth();
  addLine(truth, "aneurysm", {10, 0, 0}, {10, -4, 0}, 2, 20, BranchKind::Aneurysm);
  const Comparison result = compared(straightTruth(), truth);
  EXPECT_EQ(result.score.overlap, 1);
  EXPECT_EQ(result.score.missed, 0);
  EXPECT_EQ(result.branches[1].score.overlap, 0);
  // of 4 mm, all but what lies within its radius of the root's centerline
  EXPECT_NEAR(result.branches[1].score.missed, 2, 0.11);
}

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
