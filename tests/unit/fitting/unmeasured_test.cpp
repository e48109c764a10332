// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "converters/stages/fitting/node_models.h"
#include "formats/case/node_origin.h"
#include "tests/unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::NodeOrigin;
using formats::Vec3f;
using formats::test::addBeads;
using formats::test::alongX;

/// A trunk of radius 2 along x, and an arm of radius 1 that leaves its middle obliquely, nodes 5 to 9,
/// which is bridged. The trunk's points, one to a node, are at its far side.
Case trunkAndArm() {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", alongX(-4, 2, 5), 2);
  addBeads(value, "arm",
           {{0, 1, 0}, {0.6F, 1.8F, 0}, {1.2F, 2.6F, 0}, {1.8F, 3.4F, 0}, {2.4F, 4.2F, 0}}, 1, 2);
  formats::PointSets points{{0}, {}};
  for (std::uint32_t node = 0; node < 10; ++node) {
    if (node < 5) points.position.push_back({value.tree.centre[node].x, -2, 0});
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  value.points = std::move(points);
  std::vector<NodeOrigin> origins(10, NodeOrigin::Measured);
  for (std::uint32_t node = 5; node < 10; ++node) origins[node] = NodeOrigin::Bridged;
  setNodeOrigins(value, origins);
  return value;
}

std::vector<std::vector<Vec3f>> pointsOf(const Case& value) {
  return pointsOfUnmeasured(value, formats::Neighbours(value.tree));
}

TEST(Unmeasured, NodesHaveARingOfPointsAcrossThem) {
  const auto points = pointsOf(trunkAndArm());
  ASSERT_EQ(points[9].size(), 16U);
  for (const Vec3f& p : points[9]) {
    EXPECT_NEAR(0.6 * (p.x - 2.4) + 0.8 * (p.y - 4.2), 0, 1e-6);
    EXPECT_NEAR(std::hypot(p.x - 2.4, p.y - 4.2, p.z), 1, 1e-6);
  }
}

TEST(Unmeasured, NodesHaveNoWallInAnotherBranchsLumen) {
  const auto points = pointsOf(trunkAndArm());
  EXPECT_TRUE(points[5].empty());   // all of it is in the trunk
  EXPECT_GE(points[6].size(), 1U);  // some of it is
  EXPECT_LT(points[6].size(), 16U);
  for (const Vec3f& p : points[6])
    for (const float x : {-2.0F, 0.0F, 2.0F}) EXPECT_GE(std::hypot(p.x - x, p.y, p.z), 2);
}

TEST(Unmeasured, NodesThatHavePointsKeepToThem) {
  Case value = trunkAndArm();
  value.points->position.push_back({3, 5, 0});
  ++value.points->offset.back();
  EXPECT_TRUE(pointsOf(value)[9].empty());
}

TEST(Unmeasured, MeasuredNodesGetNothing) {
  Case value = trunkAndArm();
  for (std::uint32_t node = 0; node < 5; ++node) EXPECT_TRUE(pointsOf(value)[node].empty());
  setNodeOrigins(value, std::vector<NodeOrigin>(10, NodeOrigin::Measured));
  for (const auto& points : pointsOf(value)) EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace lumen::convert
