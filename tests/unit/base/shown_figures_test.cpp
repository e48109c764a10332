// SPDX-License-Identifier: Apache-2.0
#include "converters/base/shown_figures.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lumen {
namespace {

TEST(ShownFigures, NumbersHaveTheDigitsThatMatter) {
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

TEST(ShownFigures, TheGreatestNumberHasAllItsDigits) {
  EXPECT_EQ(fixed(1.7e308, 2).size(), 309U + 3U);
}

}  // namespace
}  // namespace lumen
