// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/flow_inlets.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/export/shared/network.h"
#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

/// "long" of 40 mm, "short" of 20 mm and "crumb" of 3 mm, side by side.
formats::Case makeParts() {
  formats::Case value;
  addBranch(value.tree, "long", -1, {5, 5, 0}, {0, 0, 1}, 41, 2);
  addBranch(value.tree, "short", -1, {15, 5, 10}, {0, 0, 1}, 21, 1);
  addBranch(value.tree, "crumb", -1, {25, 5, 0}, {0, 0, 1}, 4, 1);
  return value;
}

/// 31 x 11 x 41 voxels of a millimetre from the origin on.
formats::SourceVolume volume() {
  formats::SourceVolume source;
  source.size = {31, 11, 41};
  source.spacing = {1, 1, 1};
  source.sha256 = std::string(64, 'a');
  source.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  return source;
}

std::vector<std::string> labels(const formats::Case& value) {
  std::vector<std::string> all;
  for (const auto& branch : value.tree.branches) all.push_back(branch.label);
  return all;
}

using Labels = std::vector<std::string>;

}  // namespace

TEST(FlowInlets, FragmentsAreLeftOutAndReported) {
  const FlowCase made = flowCase(makeParts(), {});
  EXPECT_EQ(labels(made.value), (Labels{"long", "short"}));
  ASSERT_EQ(made.losses.size(), 1U);
  EXPECT_EQ(made.losses[0].find("crumb: this part, of 1 branch and 3.00 mm"), 0U) << made.losses[0];
}

TEST(FlowInlets, APartThatBeginsWithinTheVolumeHasNoInlet) {
  formats::Case value = makeParts();
  value.metadata.source = volume();
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"long"}));
  // "short" begins 1.6 mm from the border, then 1.4 mm, and its radius is 1 mm
  const auto shift = [&](float by) {
    for (auto& centre : value.tree.centre)
      if (centre.x == 15) centre.z -= by;
  };
  shift(8.4F);
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"long"}));
  shift(0.2F);
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"long", "short"}));
}

TEST(FlowInlets, StatedInletsKeepTheirPartsAlone) {
  const FlowCase made = flowCase(makeParts(), statedInlets({"crumb", "short=2.5"}));
  EXPECT_EQ(labels(made.value), (Labels{"short", "crumb"}));
  EXPECT_EQ(made.losses.size(), 1U);
}

TEST(FlowInlets, ALinkLeadsOn) {
  formats::Case value = makeParts();
  value.tree.links = {{40, 62}};
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"long", "short", "crumb"}));
}

TEST(FlowInlets, AStatedFlowEntersAtItsInlet) {
  const std::vector<StatedInlet> stated = statedInlets({"short=2.5"});
  const FlowNetwork network = flowNetwork(makeParts().tree, stated);
  for (const FlowJoint& joint : network.joints)
    if (joint.name == "inlet-short") {
      EXPECT_DOUBLE_EQ(joint.inflow, 2.5e-6);
    }
}

TEST(FlowInlets, TapersAndStubsAreLeftOutUnlessTheyAreKept) {
  formats::Case value;
  addBranch(value.tree, "trunk", -1, {15, 5, 3}, {0, 0, 1}, 31, 2);
  addBranch(value.tree, "stub", 15, {17, 5, 18}, {0.95F, 0, 0}, 3, 1);  // 1.9 mm
  addBranch(value.tree, "side", 20, {17, 5, 23}, {1.1F, 0, 0}, 3, 1);   // 2.2 mm
  value.tree.radius[30] = 0.5F;
  value.tree.radius[29] = 1.3F;
  for (auto& direction : value.tree.direction)
    if (direction.x > 0) direction = {1, 0, 0};
  value.tree.radius[28] = 1.5F;  // three quarters of the calibre
  EXPECT_EQ(labels(flowCase(value, {}, {}, true).value), (Labels{"trunk", "stub", "side"}));
  const FlowCase made = flowCase(value, {});
  EXPECT_EQ(labels(made.value), (Labels{"trunk", "side"}));
  EXPECT_EQ(made.value.tree.branches[0].nodeCount, 29U);
  ASSERT_EQ(made.losses.size(), 2U);
  EXPECT_EQ(made.losses[0].find("trunk: 2.00 mm of its end"), 0U) << made.losses[0];
  EXPECT_EQ(made.losses[1].find("stub: "), 0U) << made.losses[1];
}

TEST(FlowInlets, AShortVesselThatLeavesTheVolumeIsNoStub) {
  formats::Case value;
  addBranch(value.tree, "trunk", -1, {15, 5, 3}, {0, 0, 1}, 31, 2);
  addBranch(value.tree, "short", 15, {17, 5, 18}, {1, 0, 0}, 2, 1);
  value.metadata.source = volume();
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"trunk"}));
  value.metadata.source->size[0] = 19;  // its tip is in the last voxel
  EXPECT_EQ(labels(flowCase(value, {}).value), (Labels{"trunk", "short"}));
}

TEST(FlowInlets, RefusesLabelsThatAreNoRootsAndFlowsThatAreNone) {
  EXPECT_THROW(flowCase(makeParts(), statedInlets({"nowhere"})), Error);
  for (const char* word : {"long=", "long=fast", "long=-1", "long=0"})
    EXPECT_THROW(statedInlets({word}), Error) << word;
  EXPECT_EQ(statedInlets({"a=b=3"})[0].label, "a=b");
}

}  // namespace lumen::convert
