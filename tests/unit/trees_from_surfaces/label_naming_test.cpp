// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// 40 x 9 x 9 voxels of 1 mm, whose labels `label` gives by x; names "a", "b" and "c" of 1, 2 and 3.
template <class Label>
LabelMask maskAlong(Label label, double spacing = 1) {
  LabelMask mask;
  mask.geometry.size = {40, 9, 9};
  mask.geometry.spacing.setConstant(spacing);
  mask.values = {1, 2, 3};
  mask.names = {"a", "b", "c"};
  for (std::size_t i = 0; i < mask.geometry.voxelCount(); ++i)
    mask.label.push_back(static_cast<std::uint8_t>(label(mask.geometry.cell(i)[0])));
  return mask;
}

/// Appends a branch along x from one place to another, nodes 1 mm apart, at y = z = 4.
void addBranch(formats::Case& value, const std::string& label, int from, int to, float radius,
               std::int32_t parent = formats::kNoParent) {
  formats::CenterlineTree& tree = value.tree;
  formats::Branch branch;
  branch.label = label;
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  branch.nodeCount = static_cast<std::uint32_t>(to - from + 1);
  for (int x = from; x <= to; ++x) {
    tree.parent.push_back(x == from ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 1);
    tree.centre.push_back({static_cast<float>(x), 4, 4});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(radius);
    tree.height.push_back(1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  tree.branches.push_back(branch);
}

std::vector<std::string> labelsOf(const formats::Case& value) {
  std::vector<std::string> labels;
  for (const formats::Branch& branch : value.tree.branches) labels.push_back(branch.label);
  return labels;
}

using Labels = std::vector<std::string>;

TEST(LabelNaming, TheLongestLabelNamesABranch) {
  formats::Case value;
  addBranch(value, "found", 0, 30, 6);
  // 10 mm of the second are narrower than the 12 mm of the branch, so it is not divided
  const Naming done = nameBranches(maskAlong([](int x) { return x < 20 ? 1 : 2; }), value);
  EXPECT_EQ(labelsOf(value), Labels{"a"});
  EXPECT_EQ(done.named, 1U);
  EXPECT_EQ(done.divided, 0U);
}

TEST(LabelNaming, ABranchIsDividedWhereOneLabelFollowsAnother) {
  formats::Case value;
  addBranch(value, "found", 0, 30, 2);
  addBranch(value, "side", 26, 30, 1, 25);
  const Naming done = nameBranches(maskAlong([](int x) { return x < 20 ? 1 : 2; }), value);
  EXPECT_EQ(labelsOf(value), (Labels{"a", "b", "b-2"}));
  EXPECT_EQ(done.divided, 1U);
  const formats::CenterlineTree& tree = value.tree;
  EXPECT_EQ(tree.branches[1].firstNode, 20U);
  EXPECT_EQ(tree.branches[1].parentNode, 19);
  EXPECT_EQ(tree.branch[20], 1U);
  EXPECT_EQ(tree.branch[31], 2U);
  EXPECT_EQ(tree.branches[2].parentNode, 25);
}

TEST(LabelNaming, ShortSpecksOfAnotherLabelDivideNothing) {
  formats::Case value;
  addBranch(value, "found", 0, 30, 2);
  (void)nameBranches(maskAlong([](int x) { return x >= 10 && x < 13 ? 2 : 1; }), value);
  EXPECT_EQ(labelsOf(value), Labels{"a"});
}

TEST(LabelNaming, BranchesOnNoLabelKeepTheirNames) {
  formats::Case value;
  addBranch(value, "a", 30, 39, 2);
  addBranch(value, "found", 0, 20, 2);
  const Naming done = nameBranches(maskAlong([](int x) { return x < 25 ? 1 : 0; }), value);
  EXPECT_EQ(labelsOf(value), (Labels{"a", "a-2"}));
  EXPECT_EQ(done.bare, 1U);
}

/// A branch of 40 mm with a label along 20 <= x < 30, whose other nodes have the given radii.
Labels namesBeside(float before, float behind, int from = 20) {
  formats::Case value;
  addBranch(value, "found", 0, 39, 1);
  for (std::size_t x = 0; x < 40; ++x) {
    if (static_cast<int>(x) < from) value.tree.radius[x] = before;
    if (x >= 30) value.tree.radius[x] = behind;
  }
  (void)nameBranches(maskAlong([&](int x) { return x >= from && x < 30 ? 1 : 0; }), value);
  return labelsOf(value);
}

TEST(LabelNaming, AVesselGoesOnBeyondItsLabel) {
  EXPECT_EQ(namesBeside(1, 1, 16), (Labels{"found", "a"}));  // 16 mm before 14
  EXPECT_EQ(namesBeside(1, 1, 14), (Labels{"a"}));
  EXPECT_EQ(namesBeside(1, 1.25F, 14), (Labels{"a"}));
}

TEST(LabelNaming, AWiderVesselWithoutALabelIsNotCalledByTheOneThatLeavesIt) {
  EXPECT_EQ(namesBeside(3, 1), (Labels{"found", "a"}));
  EXPECT_EQ(namesBeside(1.27F, 1, 14), (Labels{"found", "a"}));
  EXPECT_EQ(namesBeside(1.25F, 1, 14), (Labels{"a"}));
  EXPECT_EQ(namesBeside(1, 1.27F, 14), (Labels{"a", "found"}));
  EXPECT_EQ(namesBeside(1, 6, 14), (Labels{"a"}));  // no longer than it is wide
}

TEST(LabelNaming, TheLabelOfABranchIsKnownWithoutDividingIt) {
  formats::Case value;
  addBranch(value, "found", 0, 30, 1);
  addBranch(value, "bare", 31, 39, 1);
  const std::vector<NamedStretch> along =
      labelsAlong(maskAlong([](int x) { return x >= 5 && x < 20 ? 2 : 0; }), value.tree);
  ASSERT_EQ(along.size(), 2U);
  EXPECT_EQ(along[0].label, 2);
  EXPECT_EQ(along[0].first, 5U);
  EXPECT_EQ(along[0].end, 20U);
  EXPECT_EQ(along[1].label, 0);
  EXPECT_EQ(along[1].first, along[1].end);
}

TEST(LabelNaming, TheLumenOfTheParentGivesNoName) {
  formats::Case value;
  addBranch(value, "parent", 0, 10, 4);
  addBranch(value, "child", 10, 30, 1, 10);
  (void)nameBranches(maskAlong([](int x) { return x <= 13 ? 1 : 0; }), value);
  EXPECT_EQ(labelsOf(value), (Labels{"a", "child"}));
}

TEST(LabelNaming, TheLowerLabelWinsATie) {
  formats::Case value;
  addBranch(value, "found", 0, 19, 6);
  (void)nameBranches(maskAlong([](int x) { return x < 10 ? 3 : 2; }), value);
  EXPECT_EQ(labelsOf(value), Labels{"b"});
}

TEST(LabelNaming, GridsAreComparedByPlace) {
  formats::Case value;
  addBranch(value, "found", 0, 19, 2);
  const LabelMask coarse = maskAlong([](int x) { return x < 5 ? 1 : 2; }, 2);
  (void)nameBranches(coarse, value);
  EXPECT_EQ(labelsOf(value), (Labels{"a", "b"}));
  // x = 9 is as far from the centre at 8 mm as from that at 10 mm, and rounds up
  EXPECT_EQ(value.tree.branches[1].firstNode, 9U);
}

TEST(LabelNaming, CountsLabelsWithinAVolume) {
  const LabelMask mask = maskAlong([](int x) { return x < 5 ? 1 : 0; });
  VolumeGeometry geometry;
  geometry.size = {3, 9, 9};
  EXPECT_EQ(labelledWithin(mask, geometry), 3U * 81U);
  geometry.origin = Vector3d(5, 0, 0);
  EXPECT_EQ(labelledWithin(mask, geometry), 0U);
}

}  // namespace
}  // namespace lumen::convert
