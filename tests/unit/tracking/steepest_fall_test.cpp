// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/tracking/rays.h"

namespace lumen::convert {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The first of the greatest falls, one sample at a time.
SteepestFall reference(const std::vector<float>& values, float sign) {
  std::size_t end = values.size(), best = 0;
  float strongest = 0;
  for (std::size_t i = 1; i + 1 < end; ++i) {
    const float fall = sign * (values[i - 1] - values[i + 1]);
    if (std::isnan(fall)) end = i;
    if (!(fall > strongest)) continue;
    strongest = fall;
    best = i;
  }
  if (best < 2 || best + 2 >= end) return {};
  const double before = static_cast<double>(sign * (values[best - 2] - values[best]));
  const double after = static_cast<double>(sign * (values[best] - values[best + 2]));
  const double bend = before - 2.0 * static_cast<double>(strongest) + after;
  const double shift = bend < 0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
  return {static_cast<double>(best) + shift, strongest};
}

TEST(SteepestFall, IsThatOfOneSampleAtATimeForAllLengthsAndEnds) {
  Random random(3);
  std::size_t found = 0;
  for (std::size_t size = 0; size <= 140; ++size)
    for (std::size_t beyond = 0; beyond <= std::min<std::size_t>(size, 12); ++beyond)
      for (const float sign : {1.0F, -1.0F}) {
        std::vector<float> values(size);
        // whole numbers make falls that are equal
        for (float& value : values) value = static_cast<float>(std::floor(random.uniform(0, 9)));
        // every other time the line comes back into what is known
        const std::size_t unknown = size % 2 == 0 ? beyond : (beyond + 1) / 2;
        std::fill_n(values.end() - static_cast<std::ptrdiff_t>(beyond), unknown, kNan);
        const SteepestFall expected = reference(values, sign), fall = steepestFall(values, sign);
        ASSERT_EQ(fall.sample, expected.sample) << size << ", " << beyond << " outside";
        ASSERT_EQ(fall.strength, expected.strength) << size << ", " << beyond << " outside";
        found += fall.strength > 0 ? 1U : 0U;
      }
  EXPECT_GT(found, 2000U);
}

TEST(SteepestFall, LiesBetweenSamplesByTheSlopesBeside) {
  std::vector<float> values;
  for (int i = 0; i < 40; ++i) values.push_back(static_cast<float>(std::tanh((17.3 - i) / 4)));
  EXPECT_NEAR(steepestFall(values, 1).sample, 17.3, 0.01);
  EXPECT_LT(steepestFall(values, -1).strength, 0);
}

TEST(SteepestFall, IsNoneOnALineThatBeginsOutsideOrIsEven) {
  std::vector<float> values(40, 1.0F);
  EXPECT_LT(steepestFall(values, 1).strength, 0);
  values[20] = 5;
  EXPECT_GT(steepestFall(values, 1).strength, 0);
  values[0] = kNan;
  EXPECT_LT(steepestFall(values, 1).strength, 0);
}

}  // namespace
}  // namespace lumen::convert
