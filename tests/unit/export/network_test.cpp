// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/network.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/export/shared/flow_outlets.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/stages/editing/trim.h"
#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

using formats::BranchKind;
using formats::CenterlineTree;

/// 20 mm along z with a radius of 2 mm; a side branch leaves it at 10 mm.
CenterlineTree fork() {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "side", 10, {3, 0, 10}, {1, 0, 0}, 10, 1);
  return tree;
}

const FlowSegment& segment(const FlowNetwork& network, const std::string& name) {
  for (const FlowSegment& one : network.segments)
    if (one.name == name) return one;
  throw std::runtime_error("no segment " + name);
}

std::size_t count(const FlowNetwork& network, JointKind kind) {
  std::size_t sum = 0;
  for (const FlowJoint& joint : network.joints) sum += joint.kind == kind ? 1 : 0;
  return sum;
}

}  // namespace

TEST(FlowNetwork, SplitsAParentWhereABranchLeavesIt) {
  const FlowNetwork network = flowNetwork(fork());
  ASSERT_EQ(network.segments.size(), 3U);
  EXPECT_DOUBLE_EQ(segment(network, "trunk").length(), 10);
  EXPECT_DOUBLE_EQ(segment(network, "trunk_2").length(), 10);
  const FlowJoint& junction = network.joints[segment(network, "trunk").to];
  EXPECT_EQ(junction.kind, JointKind::Junction);
  EXPECT_EQ(junction.in.size(), 1U);
  EXPECT_EQ(junction.out.size(), 2U);
  EXPECT_EQ(junction.place, Eigen::Vector3d(0, 0, 10));
}

TEST(FlowNetwork, BeginsASideBranchAtItsParentsWallWithItsOwnRadius) {
  const FlowNetwork network = flowNetwork(fork());
  const FlowSegment& side = segment(network, "side");
  EXPECT_DOUBLE_EQ(side.length(), 10);  // from x = 2 to x = 12
  EXPECT_EQ(side.points.front(), Eigen::Vector3d(2, 0, 10));
  EXPECT_DOUBLE_EQ(side.radii.front(), 1);
}

TEST(FlowNetwork, BeginsBranchesOfAnEndingParentAtItsLastNode) {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 11, 2);
  addBranch(tree, "left", 10, {1, 0, 10}, {1, 0, 0}, 5, 1);
  addBranch(tree, "right", 10, {-1, 0, 10}, {-1, 0, 0}, 5, 1);
  const FlowNetwork network = flowNetwork(tree);
  ASSERT_EQ(network.segments.size(), 3U);
  EXPECT_DOUBLE_EQ(segment(network, "left").length(), 5);
  EXPECT_DOUBLE_EQ(segment(network, "left").radii.front(), 1);
}

TEST(FlowNetwork, NamesEndsAsTheSurfaceDoes) {
  CenterlineTree tree = fork();
  const FlowNetwork one = flowNetwork(tree);
  EXPECT_EQ(one.joints[one.trees[0].inlets[0]].name, "inlet");
  EXPECT_EQ(one.joints[segment(one, "side").to].name, "outlet-side");
  addBranch(tree, "other", -1, {50, 0, 0}, {0, 0, 1}, 5, 1);
  const FlowNetwork two = flowNetwork(tree);
  ASSERT_EQ(two.trees.size(), 2U);
  EXPECT_EQ(two.joints[two.trees[1].inlets[0]].name, "inlet-other");
  EXPECT_EQ(two.trees[1].outlets.size(), 1U);
}

TEST(FlowNetwork, LeavesOutSacsAndSaysSo) {
  CenterlineTree tree = fork();
  addBranch(tree, "sac", 5, {0, 3, 5}, {0, 1, 0}, 3, 3, BranchKind::Aneurysm);
  const FlowNetwork network = flowNetwork(tree);
  EXPECT_EQ(network.segments.size(), 3U);
  ASSERT_EQ(network.messages.size(), 1U);
  EXPECT_EQ(network.messages[0], "sac: an aneurysm, which is left out");
}

TEST(FlowNetwork, KeepsASacThatAVesselHangsOn) {
  CenterlineTree tree = fork();
  addBranch(tree, "sac", 20, {0, 0, 22}, {0, 0, 1}, 4, 3, BranchKind::Aneurysm);
  addBranch(tree, "beyond", 33, {0, 0, 27}, {0, 0, 1}, 5, 1);
  const FlowNetwork network = flowNetwork(tree);
  EXPECT_EQ(network.trees.size(), 1U);
  EXPECT_EQ(count(network, JointKind::Outlet), 2U);  // none at the dome, behind the vessel
  EXPECT_EQ(network.messages.size(), 1U);
}

TEST(FlowNetwork, RefusesATreeThatNothingCanFlowOutOf) {
  CenterlineTree tree = fork();
  tree.links.push_back({20, 30});  // the ends of both
  EXPECT_THROW(flowNetwork(tree), Error);
}

TEST(FlowNetwork, JoinsALinkedVesselToTheMiddleOfAnother) {
  CenterlineTree tree = fork();
  addBranch(tree, "bridge", 15, {3, 0, 15}, {1, 0, 0}, 5, 0.5F);
  tree.links.push_back({26, 35});  // the middle of the side branch, the bridge's end
  const FlowNetwork network = flowNetwork(tree);
  ASSERT_EQ(network.trees.size(), 1U);
  EXPECT_TRUE(network.trees[0].hasLoop);
  EXPECT_EQ(count(network, JointKind::Outlet), 2U);
  EXPECT_EQ(network.segments.size(), 6U);
  EXPECT_DOUBLE_EQ(segment(network, "bridge").radii.back(), 0.5);
}

TEST(FlowNetwork, PutsAnInletBeforeARootThatForksAtOnce) {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 11, 2);
  addBranch(tree, "side", 0, {3, 0, 0}, {1, 0, 0}, 5, 1);
  const FlowNetwork network = flowNetwork(tree);
  ASSERT_EQ(network.trees[0].inlets.size(), 1U);
  const FlowJoint& inlet = network.joints[network.trees[0].inlets[0]];
  EXPECT_EQ(inlet.name, "inlet");
  EXPECT_EQ(inlet.place, Eigen::Vector3d(0, 0, -2));
  ASSERT_EQ(inlet.out.size(), 1U);
  EXPECT_DOUBLE_EQ(network.segments[inlet.out[0]].length(), 2);
}

TEST(FlowNetwork, RefusesWhatNothingCanFlowThrough) {
  CenterlineTree point;
  addBranch(point, "one", -1, {0, 0, 0}, {0, 0, 1}, 1, 2);
  EXPECT_THROW(flowNetwork(point), Error);
  CenterlineTree sac;
  addBranch(sac, "sac", -1, {0, 0, 0}, {0, 0, 1}, 5, 2, BranchKind::Aneurysm);
  EXPECT_THROW(flowNetwork(sac), Error);
}

TEST(FlowNetwork, GivesEachEdgeToOneSegment) {
  CenterlineTree tree = fork();
  addBranch(tree, "twig", 10, {-3, 0, 10}, {-1, 0, 0}, 4, 1);
  addBranch(tree, "leaf", 25, {7, 3, 10}, {0, 1, 0}, 1, 0.5F);
  const FlowNetwork network = flowNetwork(tree);
  double sum = 0;
  for (const FlowSegment& one : network.segments) sum += one.length();
  EXPECT_NEAR(sum, 20 + 10 + (1 + 3) + 2, 1e-6);  // of each guest what lies outside of its parent
}

TEST(Lumped, GivesPoiseuillesResistanceOfATube) {
  CenterlineTree tree;
  addBranch(tree, "tube", -1, {0, 0, 0}, {0, 0, 1}, 101, 2);
  const Lumped values = lumped(flowNetwork(tree).segments[0]);
  const double r = 2e-3, l = 0.1, pi = std::numbers::pi;
  EXPECT_NEAR(values.resistance / (8 * 0.004 * l / (pi * std::pow(r, 4))), 1, 1e-9);
  EXPECT_NEAR(values.inertance / (1060 * l / (pi * r * r)), 1, 1e-9);
  EXPECT_NEAR(values.compliance / (1.5 * pi * r * r * l / blood::stiffness(r)), 1, 1e-9);
}

TEST(Lumped, IntegratesACone) {
  CenterlineTree coarse, fine;
  addBranch(coarse, "cone", -1, {0, 0, 0}, {0, 0, 10}, 2, 2);
  coarse.radius[1] = 1;
  addBranch(fine, "cone", -1, {0, 0, 0}, {0, 0, 0.01F}, 1001, 2);
  for (std::size_t k = 0; k < fine.radius.size(); ++k)
    fine.radius[k] = 2 - 0.001F * static_cast<float>(k);
  const Lumped a = lumped(flowNetwork(coarse).segments[0]);
  const Lumped b = lumped(flowNetwork(fine).segments[0]);
  EXPECT_NEAR(a.resistance / b.resistance, 1, 1e-4);
  EXPECT_NEAR(a.inertance / b.inertance, 1, 1e-4);
  EXPECT_NEAR(a.compliance / b.compliance, 1, 5e-3);
}

TEST(OutletResistances, LetAFlowSplitByTheCubesOfRadii) {
  const FlowNetwork network = flowNetwork(fork());
  const std::vector<double> resistance = outletResistances(network, network.trees[0]);
  ASSERT_EQ(resistance.size(), 2U);
  EXPECT_NEAR(resistance[1] / resistance[0], 8, 1e-9);
  const double flow = blood::meanFlow(2e-3);
  EXPECT_NEAR(blood::kMeanPressure * (1 / resistance[0] + 1 / resistance[1]), flow, 1e-9 * flow);
}

// The last node of a vessel is often the tip of a taper.
TEST(OutletShares, GoByTheRadiusOfTheLastStretchAndNotOfTheTip) {
  formats::CenterlineTree tree = fork();
  const FlowNetwork whole = flowNetwork(tree);
  const std::vector<double> before = outletShares(whole, whole.trees[0]);
  const formats::Branch& trunk = tree.branches[0];
  tree.radius[trunk.firstNode + trunk.nodeCount - 1] /= 5;
  const FlowNetwork network = flowNetwork(tree);
  const std::vector<double> shares = outletShares(network, network.trees[0]);
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_NEAR(shares[0], before[0], 1e-9);
  EXPECT_NEAR(shares[0] + shares[1], 1, 1e-12);
  EXPECT_NEAR(endCalibre(network, network.trees[0].outlets[0]) /
                  endRadius(network, network.trees[0].outlets[0]),
              5, 1e-5);
  const std::vector<OutletRow> rows = outletRows(network);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].share, shares[0]);
  EXPECT_NEAR(rows[0].flow + rows[1].flow, 1e6 * network.joints[network.trees[0].inlets[0]].inflow,
              1e-9);
  EXPECT_EQ(rows[0].why().find("its last stretch, not its tip of "), 0U) << rows[0].why();
  EXPECT_EQ(rows[1].why(), "its last stretch");
  EXPECT_EQ(outletTable(rows).find("outlet,radius_mm,tip_radius_mm,share,flow_ml_s,why\noutlet-"),
            0U);
}

// Ten radii: the first five millimetres of a vessel of 1 mm are .9 wide, or a little less of them.
TEST(Calibre, IsTheMedianOverTheLastTenRadii) {
  std::vector<double> radii(50, 1.0);
  const std::vector<double> steps(49, 1.0);
  std::fill(radii.begin(), radii.begin() + 6, 0.9);
  EXPECT_EQ(calibre(radii, steps), 0.9);
  radii[5] = 1;
  EXPECT_EQ(calibre(radii, steps), 1);
  EXPECT_EQ(calibre(std::vector<double>{2}, {}), 2);
}

TEST(OutletWarnings, NameAShortVesselThatTakesMuchOfTheFlow) {
  const auto warnings = [](float radius, float length) {
    formats::CenterlineTree tree;
    addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 201, 2);
    addBranch(tree, "side", 100, {2, 0, 100}, {length / 3, 0, 0}, 4, radius);
    const FlowNetwork network = flowNetwork(tree);
    return outletWarnings(network, outletRows(network));
  };
  // shares of .5, .27 and .23; a fiftieth of the length is 4.1 mm
  ASSERT_EQ(warnings(2, 3.8F).size(), 1U);
  const Warning warning = warnings(2, 3.8F)[0];
  EXPECT_EQ(warning.text.find("outlet-side takes 50 % of the flow"), 0U);
  EXPECT_EQ(warning.code, WarningCode::FlowDoubt);
  ASSERT_EQ(warning.places.size(), 1U);
  EXPECT_NEAR(warning.places[0].x(), 2 + 3.8, 1e-5);
  EXPECT_EQ(warnings(1.436F, 3.8F).size(), 1U);
  EXPECT_TRUE(warnings(1.337F, 3.8F).empty());
  EXPECT_TRUE(warnings(2, 4.5F).empty());
}

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
  const std::string& text = warnings[0].text;
  EXPECT_NE(text.find("mmHg"), std::string::npos) << text;
  EXPECT_NE(text.find("trunk_2, which thins to a radius of 0.155 mm"), std::string::npos) << text;
}

}  // namespace lumen::convert
