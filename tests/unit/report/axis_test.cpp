// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/number_text.h"
#include "converters/draw/report/profile_plot.h"

namespace lumen::convert {
namespace {

std::string marksOf(const Axis& axis) {
  std::string text;
  for (const double mark : axis.marks)
    text.append(text.empty() ? "" : " ").append(fixedText(mark, axis.digits));
  return text;
}

TEST(Axis, MarksAreRoundAndReachNoFartherThanTheEnd) {
  EXPECT_EQ(marksOf(axisTo(469.5, 5)), "0 100 200 300 400");
  EXPECT_EQ(marksOf(axisTo(1.3, 4)), "0.0 0.5 1.0");
  EXPECT_EQ(marksOf(axisTo(0.012, 5)), "0.000 0.005 0.010");
  EXPECT_EQ(marksOf(axisTo(2, 4)), "0.0 0.5 1.0 1.5 2.0");
  EXPECT_EQ(axisTo(469.5, 5).end, 469.5);
}

TEST(Axis, HasAtMostAsManyMarksAsItMay) {
  for (double end = 1e-6; end < 1e7; end *= 1.37)
    for (const int most : {3, 4, 5}) {
      const Axis axis = axisTo(end, most);
      EXPECT_LE(axis.marks.size(), static_cast<std::size_t>(most) + 1) << end;
      EXPECT_GE(axis.marks.size(), 2U) << end << " has no mark but 0";
    }
}

TEST(Axis, WithoutAnEndItIsOne) {
  for (const double end : {0.0, -3.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(axisTo(end, 5).end, 1.0);
    EXPECT_FALSE(axisTo(end, 5).marks.empty());
  }
}

}  // namespace
}  // namespace lumen::convert
