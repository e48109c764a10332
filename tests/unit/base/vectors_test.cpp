// SPDX-License-Identifier: Apache-2.0
#include "converters/base/vectors.h"

#include <limits>

#include <gtest/gtest.h>

namespace lumen {
namespace {

TEST(IsWithin, TakesEveryCoordinateAndNoNaN) {
  EXPECT_TRUE(isWithin({-2, 2, 0}, 2));
  for (int axis = 0; axis < 3; ++axis)
    for (const double bad : {2.5, -2.5, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
      Eigen::Vector3d v(1, 1, 1);
      v[axis] = bad;
      EXPECT_FALSE(isWithin(v, 2)) << axis << " " << bad;
    }
}

}  // namespace
}  // namespace lumen
