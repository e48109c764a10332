// SPDX-License-Identifier: Apache-2.0
// The tip of a vessel that ends is dropped where it widens, as nothing holds it; that of one that leaves the volume stays.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "seeded_tubes.h"

namespace lumen::convert {
namespace {

/// A tube of radius 0.8 mm along z, which widens from `from` on by `slope`.
Volume flaredTube(double from, double slope) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) {
    const double radius = 0.8 + slope * std::max(0.0, p.z() - from);
    const double across = std::hypot(p.x() - 6.4, p.y() - 6.4) - radius;
    return std::max(across, 0.4 - p.z());
  });
}

}  // namespace

TEST(Tip, ThatWidensIsDroppedWhereTheVesselEnds) {
  for (const double slope : {0.6, 1.0, 2.0}) {
    const auto tree = trackOne(flaredTube(9, slope), {seedAt("tube", {6.4, 6.4, 4.0})}).result.tree;
    ASSERT_EQ(tree.branches.size(), 1U);
    EXPECT_EQ(tree.branches[0].stopReason, formats::StopReason::NoValidCylinder);
    EXPECT_GT(tree.centre.back().z, 8.0F);
    EXPECT_LT(tree.radius.back(), 1.12F) << slope;
  }
}

TEST(Tip, ThatWidensStaysWhereTheVesselLeavesTheVolume) {
  const auto tree = trackOne(flaredTube(11, 0.6), {seedAt("tube", {6.4, 6.4, 4.0})}).result.tree;
  ASSERT_EQ(tree.branches.size(), 1U);
  EXPECT_EQ(tree.branches[0].stopReason, formats::StopReason::LeftVolume);
  EXPECT_GT(tree.radius.back(), 1.12F);  // 1.4 times the radius before
}

}  // namespace lumen::convert
