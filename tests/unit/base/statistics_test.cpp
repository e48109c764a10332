// SPDX-License-Identifier: Apache-2.0
#include "converters/base/statistics.h"

#include <vector>

#include <gtest/gtest.h>

namespace lumen {
namespace {

std::vector<double> upTo(int count) {
  std::vector<double> values;
  for (int i = count; i >= 1; --i) values.push_back(i);
  return values;
}

TEST(Statistics, TheMedianOfAnEvenNumberIsHalfwayBetweenTheTwoMiddleValues) {
  EXPECT_EQ(median(upTo(4)), 2.5);
  EXPECT_EQ(median(upTo(5)), 3);
}

TEST(Statistics, TheUpperMedianIsOneOfTheValues) {
  std::vector<double> even = upTo(4), odd = upTo(5);
  EXPECT_EQ(upperMedian(even), 3);
  EXPECT_EQ(upperMedian(odd), 3);
}

TEST(Statistics, TheLowerQuantileRoundsItsRankDown) {
  std::vector<double> values = upTo(4);
  EXPECT_EQ(lowerQuantile(values, 0.5), 2);
  EXPECT_EQ(lowerQuantile(values, 0), 1);
  EXPECT_EQ(lowerQuantile(values, 1), 4);
}

TEST(Statistics, TheNearestRankIsNotExceededByAtLeastThatShare) {
  std::vector<double> ten = upTo(10), eleven = upTo(11);
  EXPECT_EQ(nearestRank(ten, 0.9), 9);
  EXPECT_EQ(nearestRank(eleven, 0.9), 10);
  EXPECT_EQ(nearestRank(ten, 0), 1);
  EXPECT_EQ(nearestRank(ten, 1), 10);
}

}  // namespace
}  // namespace lumen
