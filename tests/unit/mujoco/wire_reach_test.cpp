// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <gtest/gtest.h>

#include "converters/export/targets/mujoco/wire.h"

namespace lumen::convert {

namespace {

/// A square of 20 mm across the x axis at `x`, m, that looks along x (1) or against it (-1), in a box of 10 mm depth.
SurfaceMesh plate(double x, int side) {
  SurfaceMesh mesh;
  const auto at = static_cast<float>(x);
  for (const float depth : {0.0F, -0.010F})
    for (const auto& [y, z] :
         {std::pair{-0.01F, -0.01F}, {0.01F, -0.01F}, {0.01F, 0.01F}, {-0.01F, 0.01F}})
      mesh.position.push_back({at + depth, y, z});
  mesh.triangle = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};  // the last one gives the box a depth
  if (side < 0)
    for (Triangle& t : mesh.triangle) std::swap(t[1], t[2]);
  return mesh;
}

const Eigen::Vector3d kTip(0, 0, 0), kForward = Eigen::Vector3d::UnitX();

}  // namespace

TEST(WireReach, IsFreeBehindItsTipWhereNothingIs) {
  EXPECT_EQ(freeBehind({}, kTip, kForward, 0.08, 1e-4), 0.08);
  EXPECT_EQ(freeBehind({plate(0.05, 1)}, kTip, kForward, 0.08, 1e-4), 0.08);
}

TEST(WireReach, EndsAtAWallBehindItsTip) {
  // the wall of another vessel crosses what is behind the tip, solid on its far side
  EXPECT_NEAR(freeBehind({plate(-0.03, 1)}, kTip, kForward, 0.08, 1e-4), 0.03, 3e-4);
}

TEST(WireReach, IsNotFreeInWhatIsSolid) {
  EXPECT_LT(freeBehind({plate(0.005, 1)}, kTip, kForward, 0.08, 1e-4), 1e-3);
}

}  // namespace lumen::convert
