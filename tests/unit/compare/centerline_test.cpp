// SPDX-License-Identifier: Apache-2.0
// One straight vessel of 20 mm and radius 1, sampled every 0.1 mm; the last digits of the expected
// figures are of the size of one sample.
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/judge/compare/compare.h"
#include "lines.h"

namespace lumen::convert {
namespace {

CenterlineScore scoreOf(const formats::Case& found) {
  Progress progress;
  return compareCases(found, straightTruth(), progress).score;
}

formats::Case line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) {
  formats::Case value;
  addLine(value, "root", a, b, radius);
  return value;
}

TEST(CenterlineScore, OfTheTruthItselfIsPerfect) {
  const CenterlineScore score = scoreOf(straightTruth());
  EXPECT_EQ(score.overlap, 1);
  EXPECT_EQ(score.overlapUntilFirstError, 1);
  EXPECT_NEAR(score.averageInside, 0, 1e-9);
  EXPECT_NEAR(score.assd, 0, 1e-9);
  EXPECT_NEAR(score.radiusRms, 0, 1e-9);
  EXPECT_EQ(score.missed, 0);
  EXPECT_EQ(score.falseLength, 0);
}

TEST(CenterlineScore, OfALineATenthOfAMillimetreAside) {
  const CenterlineScore score = scoreOf(line({0, 0.1, 0}, {20, 0.1, 0}, 1));
  EXPECT_EQ(score.overlap, 1);
  EXPECT_NEAR(score.averageInside, 0.1, 1e-6);
  EXPECT_NEAR(score.assd, 0.1, 1e-6);
  EXPECT_NEAR(score.assdLimited, 0.1, 1e-6);
}

TEST(CenterlineScore, OfTheFirstHalf) {
  // true samples up to one radius past the end of the found line still have a partner within the
  // radius
  const CenterlineScore score = scoreOf(line({0, 0, 0}, {10, 0, 0}, 1));
  EXPECT_NEAR(score.overlap, (10 + 11) / (10 + 11 + 9.0), 0.005);
  EXPECT_NEAR(score.overlapUntilFirstError, 11 / 20.0, 0.005);
  EXPECT_NEAR(score.missed, 9, 0.11);
  EXPECT_EQ(score.falseLength, 0);
  // the missing half is 5 mm away on average: 10 * 5 / (20 + 10)
  EXPECT_NEAR(score.assd, 50 / 30.0, 0.01);
  // within the mean radius of 1 only the first millimetre of it counts: 0.5 / (11 + 10)
  EXPECT_NEAR(score.assdLimited, 0.5 / 21, 0.003);
}

TEST(CenterlineScore, AGapInTheMiddleEndsTheOverlapUntilFirstError) {
  formats::Case found = line({0, 0, 0}, {8, 0, 0}, 1);
  addLine(found, "rest", {12, 0, 0}, {20, 0, 0}, 1);
  Progress progress;
  found.tree.branches[0].label = "first";
  const CenterlineScore score = compareCases(found, straightTruth(), progress).score;
  EXPECT_NEAR(score.overlapUntilFirstError, 9 / 20.0, 0.005);
  EXPECT_NEAR(score.overlap, (16 + 18) / (16 + 18 + 2.0), 0.005);
  EXPECT_NEAR(score.missed, 2, 0.11);
}

TEST(CenterlineScore, AMissingBeginningOfLessThanADiameterIsNoFirstError) {
  const CenterlineScore score = scoreOf(line({2.5, 0, 0}, {20, 0, 0}, 1));
  EXPECT_EQ(score.overlapUntilFirstError, 1);
  EXPECT_NEAR(score.missed, 1.5, 0.11);
}

TEST(CenterlineScore, OfALineThreeRadiiAsideIsZero) {
  const CenterlineScore score = scoreOf(line({0, 3, 0}, {20, 3, 0}, 1));
  EXPECT_EQ(score.overlap, 0);
  EXPECT_EQ(score.overlapUntilFirstError, 0);
  EXPECT_TRUE(std::isnan(score.averageInside));
  EXPECT_TRUE(std::isnan(score.assdLimited));
  EXPECT_NEAR(score.assd, 3, 1e-6);
  EXPECT_NEAR(score.missed, 20, 0.11);
  EXPECT_NEAR(score.falseLength, 20, 0.11);
}

TEST(CenterlineScore, RunningFiveMillimetresTooFarIsFalsePastOneRadius) {
  const CenterlineScore score = scoreOf(line({0, 0, 0}, {25, 0, 0}, 1));
  EXPECT_NEAR(score.overlap, (20 + 21) / (20 + 21 + 4.0), 0.005);
  EXPECT_NEAR(score.falseLength, 4, 0.11);
  EXPECT_EQ(score.missed, 0);
  EXPECT_EQ(score.overlapUntilFirstError, 1);
}

TEST(CenterlineScore, DoesNotDependOnTheSenseOfTheFoundLine) {
  const CenterlineScore score = scoreOf(line({20, 0.1, 0}, {0, 0.1, 0}, 1));
  EXPECT_EQ(score.overlap, 1);
  EXPECT_NEAR(score.averageInside, 0.1, 1e-6);
}

TEST(CenterlineScore, RadiusBiasAndRmsOfAVesselFoundTenPerCentTooWide) {
  const CenterlineScore score = scoreOf(line({0, 0, 0}, {20, 0, 0}, 1.1));
  EXPECT_NEAR(score.radiusBias, 0.1, 1e-6);
  EXPECT_NEAR(score.radiusRms, 0.1, 1e-6);
}

TEST(CenterlineScore, RadiusErrorsOfBothSignsCancelInTheBiasOnly) {
  formats::Case found = line({0, 0, 0}, {20, 0, 0}, 1);
  for (std::size_t n = 0; n < found.tree.nodeCount(); ++n)
    found.tree.radius[n] = n < 20 ? 0.8F : 1.2F;
  found.tree.radius[20] = 1.0F;
  const CenterlineScore score = scoreOf(found);
  EXPECT_NEAR(score.radiusBias, 0, 0.003);
  EXPECT_NEAR(score.radiusRms, 0.2, 0.005);
}

TEST(CenterlineScore, OfAnEmptyCaseMissesEverything) {
  const CenterlineScore score = scoreOf(formats::Case{});
  EXPECT_EQ(score.overlap, 0);
  EXPECT_NEAR(score.missed, 20, 0.11);
  EXPECT_TRUE(std::isnan(score.assd));
  EXPECT_TRUE(std::isnan(score.radiusBias));
}

TEST(CenterlineScore, ATruthWithoutBranchesIsRefused) {
  Progress progress;
  try {
    compareCases(straightTruth(), formats::Case{}, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
  }
}

TEST(CenterlineScore, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(compareCases(straightTruth(), straightTruth(), progress), Error);
}

TEST(CenterlineScore, IsTheSameForAnyNumberOfThreads) {
  formats::Case found = line({0, 0.2, 0.1}, {19, 0.1, 0}, 1.05);
  const CenterlineScore many = scoreOf(found);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many.assd, scoreOf(found).assd);
}

}  // namespace
}  // namespace lumen::convert
