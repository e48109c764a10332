// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/oned/oned_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

/// A network of straight segments between joints, of which `inlets` have an inlet and those that nothing leaves an outlet.
FlowNetwork networkOf(const std::vector<std::array<std::uint32_t, 2>>& segments,
                      std::uint32_t inlets = 1) {
  FlowNetwork network;
  network.trees.emplace_back();
  for (const auto& [from, to] : segments) {
    FlowSegment segment;
    segment.name = std::to_string(network.segments.size());
    segment.from = from;
    segment.to = to;
    segment.points = {{0, 0, 0}, {0, 0, 10}};
    segment.radii = {1, 1};
    network.joints.resize(std::max<std::size_t>(network.joints.size(), std::max(from, to) + 1));
    network.joints[from].out.push_back(static_cast<std::uint32_t>(network.segments.size()));
    network.joints[to].in.push_back(static_cast<std::uint32_t>(network.segments.size()));
    network.segments.push_back(segment);
  }
  for (std::uint32_t j = 0; j < network.joints.size(); ++j) {
    FlowJoint& joint = network.joints[j];
    joint.name = std::to_string(j);
    if (j < inlets) joint.kind = JointKind::Inlet, network.trees[0].inlets.push_back(j);
    if (joint.out.empty()) joint.kind = JointKind::Outlet, network.trees[0].outlets.push_back(j);
  }
  return network;
}

std::size_t most(const OneDNetwork& network) {
  std::vector<std::size_t> degree(network.nodes.size(), 0);
  for (const OneDVessel& vessel : network.vessels) ++degree[vessel.from], ++degree[vessel.to];
  return *std::max_element(degree.begin(), degree.end());
}

}  // namespace

TEST(OneDNetwork, LeavesJunctionsOfThreeAsTheyAre) {
  const OneDNetwork network = oneDNetwork(networkOf({{0, 1}, {1, 2}, {1, 3}}), 0);
  EXPECT_EQ(network.vessels.size(), 3U);
  EXPECT_EQ(network.nodes.size(), 4U);
  EXPECT_EQ(network.stubs, 0U);
}

TEST(OneDNetwork, SplitsJunctionsOfMoreByStubsOfARadius) {
  const OneDNetwork network = oneDNetwork(networkOf({{0, 1}, {1, 2}, {1, 3}, {1, 4}, {1, 5}}), 0);
  EXPECT_EQ(network.stubs, 2U);
  EXPECT_EQ(network.vessels.size(), 7U);
  EXPECT_EQ(most(network), 3U);
  for (const OneDVessel& vessel : network.vessels)
    EXPECT_DOUBLE_EQ(vessel.length, vessel.name.starts_with("stub") ? 1e-3 : 1e-2);
}

TEST(OneDNetwork, SplitsOneOfTwoVesselsBetweenTheSameNodes) {
  const OneDNetwork network = oneDNetwork(networkOf({{0, 1}, {1, 2}, {1, 2}, {2, 3}}), 0);
  EXPECT_EQ(network.vessels.size(), 5U);
  double length = 0;
  for (const OneDVessel& vessel : network.vessels) length += vessel.length;
  EXPECT_NEAR(length, 0.04, 1e-12);
}

TEST(OneDNetwork, KeepsTheResistanceOfABumpyVessel) {
  FlowNetwork bumpy = networkOf({{0, 1}});
  bumpy.segments[0].points = {{0, 0, 0}, {0, 0, 5}, {0, 0, 10}};
  bumpy.segments[0].radii = {2, 0.5, 1};
  const OneDVessel cone = oneDNetwork(bumpy, 0).vessels[0];
  const double a = cone.inRadius, b = cone.outRadius;
  EXPECT_NEAR(a / b, 2, 1e-9);
  const double resistance =
      8 * 0.004 / std::numbers::pi * cone.length * (a * a + a * b + b * b) / 3 / std::pow(a * b, 3);
  EXPECT_NEAR(resistance / lumped(bumpy.segments[0]).resistance, 1, 1e-9);
}

TEST(OneDNetwork, RefusesTwoInletsIntoOneTree) {
  EXPECT_THROW(oneDNetwork(networkOf({{0, 2}, {1, 2}, {2, 3}}, 2), 0), Error);
}

TEST(OneDNetwork, RefusesAJunctionThatNothingLeaves) {
  FlowNetwork network = networkOf({{0, 1}, {1, 2}, {1, 3}, {1, 4}, {4, 3}});
  network.joints[3].kind = JointKind::Junction;
  EXPECT_THROW(oneDNetwork(network, 0), Error);
}

}  // namespace lumen::convert
