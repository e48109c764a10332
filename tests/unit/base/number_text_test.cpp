// SPDX-License-Identifier: Apache-2.0
#include "converters/base/number_text.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "formats/view/text_rules.h"

namespace lumen {
namespace {

TEST(NumberText, FiguresHaveTheDigitsThatMatter) {
  EXPECT_EQ(shownFigure(3614.2), "3614");
  EXPECT_EQ(shownFigure(61.24), "61.2");
  EXPECT_EQ(shownFigure(0.519), "0.52");
  EXPECT_EQ(shownFigure(NAN), "?");
  EXPECT_EQ(shownBytes(1), "1 byte");
  EXPECT_EQ(shownBytes(999), "999 bytes");
  EXPECT_EQ(shownBytes(1000), "1.0 kB");
  EXPECT_EQ(shownBytes(16433984), "16 MB");
  EXPECT_EQ(shownBytes(999'600), "1.0 MB");
}

TEST(NumberText, TheGreatestNumberHasAllItsDigits) {
  EXPECT_EQ(fixedText(1.7e308, 2).size(), 309U + 3U);
}

TEST(NumberText, DecimalsHaveNoSignOfNothing) {
  EXPECT_EQ(fixedText(-0.004, 2), "0.00");
  EXPECT_EQ(fixedText(-0.006, 2), "-0.01");
  EXPECT_EQ(fixedText(0, 0), "0");
}

TEST(NumberText, ValuesThatAreMissingOrNotFiniteAreADash) {
  EXPECT_EQ(fixedText({}, 2), "-");
  EXPECT_EQ(fixedText(std::nan(""), 2), "-");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(NumberText, JoinedNumbersAreWholeInFullAndRealWithSixDigits) {
  EXPECT_EQ(joinedNumbers(std::array<int, 2>{1234567, -8}, " x "), "1234567 x -8");
  EXPECT_EQ(joinedNumbers(std::array<double, 3>{1234567, 0.5, -0.0}, ", "), "1.23457e+06, 0.5, 0");
  EXPECT_EQ(joinedNumbers(std::array<double, 0>{}, ", "), "");
}

TEST(NumberText, NumbersThatAMessageRefusesHaveSixDecimalsOrTheirName) {
  EXPECT_EQ(foundNumber(2.5), "2.500000");
  EXPECT_EQ(foundNumber(std::nan("")), "nan");
  EXPECT_EQ(foundNumber(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(NumberText, SignificantDigitsEndWhereTheNumberDoes) {
  EXPECT_EQ(numberText(0.5), "0.5");
  EXPECT_EQ(numberText(1.0 / 3), "0.333333333");
  EXPECT_EQ(numberText(1234567890.0), "1.23456789e+09");
  EXPECT_EQ(numberText(-0.0), "0");
  EXPECT_EQ(shownNumber(1.0 / 3), "0.333333");
  EXPECT_EQ(shownNumber(2e-5, 2), "2e-05");
}

TEST(NumberText, ExactTextsReadBackAsTheSameNumber) {
  EXPECT_EQ(exactText(0.1), "0.1");
  EXPECT_EQ(exactText(1e5), "100000");
  EXPECT_EQ(exactText(0.1 + 0.2), "0.30000000000000004");
}

TEST(NumberText, ShortestTextsReadBackAsTheSameNumber) {
  EXPECT_EQ(formats::shortText(0.1F), "0.1");
  EXPECT_EQ(formats::shortText(1e5F), "1e+05");
  EXPECT_EQ(formats::shortText(-0.0F), "-0");
}

TEST(NumberText, PaddedNumbersAreNeverCut) {
  EXPECT_EQ(paddedNumber(7, 3), "007");
  EXPECT_EQ(paddedNumber(1234, 3), "1234");
}

}  // namespace
}  // namespace lumen
