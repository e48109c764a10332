// SPDX-License-Identifier: Apache-2.0
// Which found branch answers for which true one. The truth is a T: a root of 20 mm and radius 1
// along x, and a child of 10 mm and radius 0.5 that leaves it upwards at x = 10.
#include <cmath>

#include <gtest/gtest.h>

#include "converters/judge/compare/compare.h"
#include "lines.h"

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

}  // namespace
}  // namespace lumen::convert
