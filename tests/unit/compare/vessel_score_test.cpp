// SPDX-License-Identifier: Apache-2.0
// The measuring instrument of lumen_vessels. The truth is a T: a root of 20 mm and radius 1 along x,
// and a child of 10 mm and radius 0.5 that leaves it upwards at x = 10.
#include "tests/evaluation/reproduce/vessel_score.h"

#include <gtest/gtest.h>

#include "lines.h"

namespace lumen::reproduce {
namespace {

using convert::addLine;

formats::Case teeTruth() {
  formats::Case truth = convert::straightTruth();
  addLine(truth, "b01", {10, 0, 0}, {10, 10, 0}, 0.5, 20);
  return truth;
}

VesselScore scored(const formats::Case& found,
                   const std::set<std::string>& clicked = {"root", "b01"}) {
  Progress progress;
  return scoreVessels(found, teeTruth(), clicked, progress);
}

TEST(VesselScore, OfTheTruthItselfIsWholeAndHasNothingFalse) {
  const VesselScore score = scored(teeTruth());
  EXPECT_NEAR(score.clicked, 30, 0.3);
  EXPECT_DOUBLE_EQ(score.covered, score.clicked);
  EXPECT_DOUBLE_EQ(score.falseLength, 0);
  EXPECT_TRUE(score.uncovered.empty());
  EXPECT_TRUE(score.wrong.empty());
}

TEST(VesselScore, AVesselIsCoveredUnderAnyLabelAndByALinkToTheParent) {
  formats::Case found;
  addLine(found, "one", {0, 0.4, 0}, {20, 0.4, 0}, 1);
  addLine(found, "two", {10, 4, 0}, {10, 10, 0}, 0.5, 20);
  const VesselScore score = scored(found);
  EXPECT_DOUBLE_EQ(score.covered, score.clicked);
}

TEST(VesselScore, WhatIsMissedIsListedWithItsPlaceLongestFirst) {
  formats::Case found;
  addLine(found, "root", {0, 0, 0}, {17, 0, 0}, 1);
  addLine(found, "b01", {10, 1, 0}, {10, 3, 0}, 0.5, 20);
  const VesselScore score = scored(found);
  ASSERT_EQ(score.uncovered.size(), 2U);
  const AxisPiece& child = score.uncovered[0];
  EXPECT_EQ(child.branch, "b01");
  EXPECT_NEAR(child.from, 3.5, 0.11);  // the axis ends a radius before
  EXPECT_NEAR(child.to, 10, 1e-6);
  EXPECT_NEAR(child.length, 6.5, 0.2);
  EXPECT_NEAR(child.place.y(), 3.5, 0.11);
  EXPECT_NEAR(child.radius, 0.5, 1e-6);
  EXPECT_NEAR(score.uncovered[1].length, 2, 0.2);
  EXPECT_NEAR(score.covered, 30 - 8.5, 0.4);
  EXPECT_NEAR(score.thin, child.length, 1e-9);  // 0.5 mm are 1.25 voxels, 1 mm is not thin
}

TEST(VesselScore, ARowOfPiecesOfOneVesselIsListedPieceByPiece) {
  formats::Case found;
  addLine(found, "a", {0, 0, 0}, {4, 0, 0}, 1);
  addLine(found, "b", {9, 0, 0}, {12, 0, 0}, 1);
  const VesselScore score = scored(found, {"root"});
  ASSERT_EQ(score.uncovered.size(), 2U);
  EXPECT_NEAR(score.uncovered[0].from, 13, 0.2);
  EXPECT_NEAR(score.uncovered[1].from, 5, 0.2);
  EXPECT_NEAR(score.uncovered[1].length, 3, 0.2);
}

TEST(VesselScore, WhatLeavesEveryTrueLumenByHalfAVoxelIsFalse) {
  formats::Case found = teeTruth();
  addLine(found, "astray", {5, 0, 0}, {5, 0, 6}, 0.5, 10);
  const VesselScore score = scored(found);
  EXPECT_NEAR(score.falseLength, 6 - 1.2, 0.2);
  ASSERT_EQ(score.wrong.size(), 1U);
  EXPECT_EQ(score.wrong[0].branch, "astray");
  EXPECT_NEAR(score.wrong[0].place.z(), 1.2, 0.11);
}

TEST(VesselScore, CountsClickedVesselsOnlyAndWhatLiesInOthersIsNotFalse) {
  formats::Case found;
  addLine(found, "x", {10, 0, 0}, {10, 10, 0}, 0.5);
  const VesselScore score = scored(found, {"root"});
  EXPECT_NEAR(score.clicked, 20, 0.2);
  EXPECT_NEAR(score.covered, 2, 0.2);
  EXPECT_DOUBLE_EQ(score.falseLength, 0);
}

}  // namespace
}  // namespace lumen::reproduce
