// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/flow_pressure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

std::uint32_t inletOf(const FlowNetwork& network) {
  return network.trees.front().inlets.front();
}

/// A trunk of 2 mm that ends in a branch whose radius is `radius`, mm.
FlowNetwork withTail(double radius) {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "tail", 10, {3, 0, 10}, {1, 0, 0}, 20, static_cast<float>(radius));
  addBranch(tree, "end", 20, {0, 0, 21}, {0, 0, 1}, 5, static_cast<float>(radius));
  return flowNetwork(tree);
}

}  // namespace

TEST(FlowPressure, AtTheInletOfATubeIsThatOfTheOutletAndPoiseuillesDrop) {
  CenterlineTree tree;
  addBranch(tree, "a", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  const FlowNetwork network = flowNetwork(tree);
  const double r = 2e-3, flow = blood::kMeanVelocity * std::numbers::pi * r * r;
  const double drop = 8 * blood::kViscosity * 0.02 / (std::numbers::pi * r * r * r * r) * flow;
  EXPECT_NEAR(steadyPressures(network)[inletOf(network)], blood::kMeanPressure + drop, 1e-6);
}

TEST(FlowPressure, OfSeveralOutletsBalancesAtEachJunction) {
  const FlowNetwork network = withTail(1);
  const std::vector<double> p = steadyPressures(network);
  for (const FlowJoint& joint : network.joints) {
    if (joint.kind != JointKind::Junction) continue;
    double sum = 0, greatest = 0;
    const auto add = [&](std::uint32_t s, double sign) {
      const FlowSegment& one = network.segments[s];
      const double flow = (p[one.from] - p[one.to]) / lumped(one).resistance;
      sum += sign * flow;
      greatest = std::max(greatest, std::abs(flow));
    };
    for (const std::uint32_t s : joint.in) add(s, 1);
    for (const std::uint32_t s : joint.out) add(s, -1);
    EXPECT_NEAR(sum, 0, 1e-9 * greatest);
  }
}

TEST(FlowPressure, BeyondNatureIsReportedWithTheThinVesselThatCausesIt) {
  EXPECT_TRUE(pressureWarnings(withTail(1)).empty());
  const auto warnings = pressureWarnings(withTail(0.155));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("mmHg"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("tail, which thins to a radius of 0.155 mm"), std::string::npos)
      << warnings[0];
}

}  // namespace lumen::convert
