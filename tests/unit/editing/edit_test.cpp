// SPDX-License-Identifier: Apache-2.0
// Each edit on a case of beads: "a" along x with a node at every half millimetre, and two that hang on it.
#include "converters/stages/editing/edit.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "formats/case/case_file.h"
#include "formats/case/node_origin.h"
#include "formats/case/topology.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"
#include "unit/formats/sample_case.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;
using formats::Case;
using formats::kNoParent;
using formats::NodeOrigin;
using formats::test::addBeads;
using formats::test::alongX;
using Nodes = std::vector<std::uint32_t>;

/// "a" has nodes 0 to 10, "b" 11 to 15 on node 10, "c" 16 to 20 on node 4, "d" 21 to 25 on node 18.
Case smallTree() {
  Case value = formats::test::noBeads();
  value.metadata.voxelSize = 0.4;
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  addBeads(value, "b", alongX(5.5F, 0.5F, 5), 1, 10);
  addBeads(value, "c", alongX(2, 0.5F, 5, 0.5F), 1, 4);
  addBeads(value, "d", alongX(3, 0.5F, 5, 1), 1, 18);
  value.points.emplace();
  value.points->offset.push_back(0);
  for (const auto& c : value.tree.centre) {
    value.points->position.push_back({c.x, c.y + 1, c.z});
    value.points->position.push_back({c.x, c.y, c.z + 1});
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  return value;
}

std::vector<std::string> labelsOf(const Case& value) {
  std::vector<std::string> labels;
  for (const auto& branch : value.tree.branches) labels.push_back(branch.label);
  return labels;
}

std::uint32_t named(const Case& value, const std::string& label) {
  for (std::uint32_t b = 0; b < value.tree.branches.size(); ++b)
    if (value.tree.branches[b].label == label) return b;
  ADD_FAILURE() << "no branch " << label;
  return 0;
}

const formats::Branch& branchOf(const Case& value, const std::string& label) {
  return value.tree.branches[named(value, label)];
}

/// The nodes of a branch as they were counted before.
Nodes oldNodes(const Case& value, const Change& change, const std::string& label) {
  const auto& branch = branchOf(value, label);
  const auto first = change.before.begin() + branch.firstNode;
  return {first, first + branch.nodeCount};
}

/// Parent of a branch before the edit; -1 for a root.
int oldParent(const Case& value, const Change& change, const std::string& label) {
  const std::int32_t node = branchOf(value, label).parentNode;
  return node == kNoParent ? -1 : static_cast<int>(change.before[static_cast<std::size_t>(node)]);
}

Nodes range(std::uint32_t first, std::uint32_t last) {
  Nodes nodes;
  for (std::uint32_t n = first; n <= last; ++n) nodes.push_back(n);
  return nodes;
}

Nodes downFrom(std::uint32_t last, std::uint32_t first) {
  Nodes nodes = range(first, last);
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

Nodes staleBefore(const Change& change) {
  Nodes nodes;
  for (const std::uint32_t node : change.stale) nodes.push_back(change.before[node]);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

std::string refusal(Case value, const std::function<void(Case&)>& edit) {
  const Case before = value;
  try {
    edit(value);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_EQ(value, before);
    return error.what();
  }
  ADD_FAILURE() << "it was done";
  return {};
}

TEST(DeleteBranch, LeavesWhatHungOnItAsTrees) {
  Case value = smallTree();
  const Change change = deleteBranch(value, named(value, "c"));
  EXPECT_EQ(labelsOf(value), (std::vector<std::string>{"a", "b", "d"}));
  EXPECT_EQ(oldNodes(value, change, "d"), range(21, 25));
  EXPECT_EQ(oldParent(value, change, "d"), -1);
  // all that had a node of c within two edges
  EXPECT_EQ(staleBefore(change), (Nodes{3, 4, 5, 21, 22}));
}

TEST(DeleteBranch, TakesWhatHangsOnItWhenAsked) {
  Case value = smallTree();
  deleteBranch(value, named(value, "c"), Hanging::Go);
  EXPECT_EQ(labelsOf(value), (std::vector<std::string>{"a", "b"}));
}

TEST(DeleteBranch, RefusesToLeaveNothing) {
  EXPECT_NE(refusal(smallTree(), [](Case& c) { deleteBranch(c, 0, Hanging::Go); })
                .find("nothing would be left"),
            std::string::npos);
  EXPECT_EQ(refusal(smallTree(), [](Case& c) { deleteBranch(c, 4); }),
            "found branch 4, expected one from 0 to 3");
}

TEST(CutBefore, MakesTheRestATreeOfItsOwn) {
  Case value = smallTree();
  const Change change = cutBefore(value, 7);
  EXPECT_EQ(labelsOf(value), (std::vector<std::string>{"a", "a-2", "b", "c", "d"}));
  EXPECT_EQ(oldNodes(value, change, "a"), range(0, 6));
  EXPECT_EQ(oldNodes(value, change, "a-2"), range(7, 10));
  EXPECT_EQ(oldParent(value, change, "a-2"), -1);
  EXPECT_EQ(oldParent(value, change, "b"), 10);
  EXPECT_EQ(staleBefore(change), range(5, 8));
}

TEST(CutBefore, ThatLeavesTheLumenWholeMakesNothingStaleAndIsUndoneByMerging) {
  Case value = smallTree();
  Case before = value;
  EXPECT_TRUE(cutBefore(value, 7, Rest::Child, "far").stale.empty());
  EXPECT_EQ(branchOf(value, "far").parentNode, 6);
  EXPECT_TRUE(mergeIntoParent(value, named(value, "far")).stale.empty());
  EXPECT_EQ(value.tree, before.tree);
  EXPECT_EQ(value.points, before.points);
  EXPECT_EQ(value.models, before.models);
}

TEST(CutBefore, RefusesTheFirstNodeAndNamesThatAreTaken) {
  EXPECT_NE(refusal(smallTree(), [](Case& c) { cutBefore(c, 16); }).find("node 1 of \"c\""),
            std::string::npos);
  EXPECT_NE(refusal(smallTree(), [](Case& c) { cutBefore(c, 18, Rest::Child, "d"); })
                .find("the name \"d\" is that of another branch"),
            std::string::npos);
}

TEST(JoinBranch, BridgesTheGapWithNodesHalfARadiusApart) {
  Case value = smallTree();
  deleteBranch(value, named(value, "c"));
  const Change change = joinBranch(value, named(value, "d"), 0);
  // from (0, 0, 0) to (3, 1, 0): 3.16 mm, so six steps of 0.53 mm with five nodes between
  const auto& branch = branchOf(value, "d");
  EXPECT_EQ(branch.parentNode, 0);
  ASSERT_EQ(branch.nodeCount, 10U);
  const auto origins = formats::readNodeOrigins(value);
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::uint32_t node = branch.firstNode + i;
    const bool isNew = i < 5;
    EXPECT_EQ(origins[node], isNew ? NodeOrigin::Bridged : NodeOrigin::Measured);
    EXPECT_EQ(change.before[node] == kNewNode, isNew);
    EXPECT_EQ(value.points->offset[node + 1] - value.points->offset[node], isNew ? 0U : 2U);
    if (!isNew) continue;
    EXPECT_NEAR(value.tree.centre[node].x, 0.5 * (i + 1), 1e-6);
    EXPECT_EQ(value.tree.radius[node], 1);
    EXPECT_TRUE(std::binary_search(change.stale.begin(), change.stale.end(), node));
  }
}

TEST(JoinBranch, DropsTheBridgeToWhatItHungOnBefore) {
  Case value = smallTree();
  joinBranch(value, named(value, "d"), 0);
  joinBranch(value, named(value, "d"), 14);
  // from (7, 0, 0) to (3, 1, 0): 4.12 mm
  EXPECT_EQ(branchOf(value, "d").nodeCount, 5U + 7U);
  joinBranch(value, named(value, "d"), 18);
  EXPECT_EQ(branchOf(value, "d").nodeCount, 5U);
}

TEST(JoinBranch, RefusesItsOwnNodesAndThoseBelow) {
  EXPECT_NE(refusal(smallTree(), [](Case& c) { joinBranch(c, 2, 22); }).find("hangs on it"),
            std::string::npos);
  EXPECT_NE(refusal(smallTree(), [](Case& c) { joinBranch(c, 2, 17); }).find("part of it"),
            std::string::npos);
  EXPECT_NE(refusal(smallTree(), [](Case& c) { joinBranch(c, 1, 10); }).find("already"),
            std::string::npos);
}

TEST(JoinBranch, RefusesAWayOfVeryManyNodes) {
  Case value = smallTree();
  value.tree.radius[0] = 1e-6F;
  EXPECT_NE(refusal(value, [](Case& c) { joinBranch(c, 1, 0); }).find("more than 20000 nodes"),
            std::string::npos);
}

TEST(JoinBranch, DropsALinkThatBecomesAnEdge) {
  Case value = smallTree();
  value.tree.links = {{3, 11}};
  joinBranch(value, 2, 11);
  EXPECT_EQ(value.tree.links.size(), 1U);
  // half a millimetre from the first node of b, where no bridge has room
  value.tree.centre[11] = {1.5F, 0.4F, 0};
  joinBranch(value, 1, 3);
  EXPECT_EQ(branchOf(value, "b").nodeCount, 5U);
  EXPECT_TRUE(value.tree.links.empty());
}

TEST(MergeIntoParent, ContinuesTheParent) {
  Case value = smallTree();
  const Change change = mergeIntoParent(value, named(value, "b"));
  EXPECT_EQ(labelsOf(value), (std::vector<std::string>{"a", "c", "d"}));
  EXPECT_EQ(oldNodes(value, change, "a"), range(0, 15));
  EXPECT_TRUE(change.stale.empty());
}

TEST(MergeIntoParent, RefusesBranchesThatLeaveTheMiddle) {
  const std::string text = refusal(smallTree(), [](Case& c) { mergeIntoParent(c, 2); });
  EXPECT_NE(text.find("\"c\" hangs on node 5 of \"a\", which goes on to node 11"),
            std::string::npos)
      << text;
  EXPECT_NE(refusal(smallTree(), [](Case& c) { mergeIntoParent(c, 0); }).find("hangs on no branch"),
            std::string::npos);
}

TEST(ReverseBranch, TurnsARootRoundAndKeepsEveryEdge) {
  Case value = smallTree();
  const Change change = reverseBranch(value, 0);
  EXPECT_EQ(oldNodes(value, change, "a"), downFrom(10, 0));
  EXPECT_EQ(oldParent(value, change, "b"), 10);
  EXPECT_EQ(oldParent(value, change, "c"), 4);
  EXPECT_EQ(value.tree.direction[0], (formats::Vec3f{-1, 0, 0}));
  EXPECT_TRUE(change.stale.empty());
}

TEST(ReverseBranch, LetsGoOfTheParent) {
  Case value = smallTree();
  const Change change = reverseBranch(value, named(value, "c"));
  EXPECT_EQ(oldNodes(value, change, "c"), downFrom(20, 16));
  EXPECT_EQ(oldParent(value, change, "c"), -1);
  EXPECT_EQ(oldParent(value, change, "d"), 18);
  EXPECT_EQ(staleBefore(change), (Nodes{3, 4, 5, 16, 17}));
}

TEST(MakeRoot, TurnsRoundWhatLiesBetweenAndDividesTheBranchThatGoesOn) {
  Case value = smallTree();
  const Change change = makeRoot(value, named(value, "d"));
  EXPECT_EQ(oldNodes(value, change, "d"), downFrom(25, 21));
  EXPECT_EQ(oldParent(value, change, "d"), -1);
  // "c" is divided at node 18 into two nodes on the way and two beyond, "a" at node 4
  EXPECT_EQ(oldNodes(value, change, "c"), (Nodes{18, 17, 16}));
  EXPECT_EQ(oldParent(value, change, "c"), 21);
  EXPECT_EQ(oldNodes(value, change, "c-2"), (Nodes{19, 20}));
  EXPECT_EQ(oldParent(value, change, "c-2"), 18);
  EXPECT_EQ(oldNodes(value, change, "a-2"), downFrom(4, 0));
  EXPECT_EQ(oldParent(value, change, "a-2"), 16);
  EXPECT_EQ(oldNodes(value, change, "a"), range(5, 10));
  EXPECT_EQ(oldParent(value, change, "a"), 4);
  EXPECT_TRUE(change.stale.empty());
}

TEST(MakeRoot, KeepsABranchWholeThatTheWayLeavesByItsFirstNode) {
  Case value = smallTree();
  joinBranch(value, named(value, "c"), 0);
  const Change change = makeRoot(value, named(value, "c"));
  EXPECT_EQ(oldNodes(value, change, "a"), range(0, 10));
  EXPECT_EQ(labelsOf(value), (std::vector<std::string>{"c", "a", "b", "d"}));
}

TEST(MakeRoot, RefusesARoot) {
  EXPECT_NE(refusal(smallTree(), [](Case& c) { makeRoot(c, 0); }).find("is the root"),
            std::string::npos);
}

TEST(SetKind, MakesTheBranchAndItsSurroundingsStale) {
  Case value = smallTree();
  const Change change = setKind(value, named(value, "b"), BranchKind::Aneurysm);
  EXPECT_EQ(branchOf(value, "b").kind, BranchKind::Aneurysm);
  EXPECT_EQ(staleBefore(change), range(9, 15));
}

TEST(RenameBranch, TakesAnyNameThatIsFree) {
  Case value = smallTree();
  const Case before = value;
  EXPECT_TRUE(renameBranch(value, 1, "A. cerebri média <b>").stale.empty());
  EXPECT_EQ(value.tree.branches[1].label, "A. cerebri média <b>");
  renameBranch(value, 1, "b");
  EXPECT_EQ(value.tree, before.tree);
}

TEST(RenameBranch, RefusesNamesThatAreNone) {
  const auto rename = [](const std::string& label) {
    return refusal(smallTree(), [&](Case& c) { renameBranch(c, 1, label); });
  };
  EXPECT_NE(rename("").find("empty"), std::string::npos);
  EXPECT_NE(rename("a").find("another branch"), std::string::npos);
  EXPECT_NE(rename("x\ny").find("control"), std::string::npos);
  EXPECT_NE(rename("\xff").find("UTF-8"), std::string::npos);
  EXPECT_NE(rename(std::string(256, 'x')).find("255"), std::string::npos);
}

TEST(MoveNode, GivesARoundSectionWithoutTheWallPointsThatWereThere) {
  Case value = smallTree();
  const Change change = moveNode(value, 5, {2.6, 0.2, 0}, 1.5);
  EXPECT_EQ(value.tree.centre[5], (formats::Vec3f{2.6F, 0.2F, 0}));
  EXPECT_EQ(value.tree.radius[5], 1.5F);
  EXPECT_EQ(value.tree.direction[5], (formats::Vec3f{1, 0, 0}));
  EXPECT_EQ(formats::readNodeOrigins(value)[5], NodeOrigin::Given);
  EXPECT_EQ(value.points->offset[6], value.points->offset[5]);
  // those of other nodes lie beyond the planes halfway to them
  EXPECT_EQ(value.points->position.size(), 2U * 25);
  // two edges along a, and the first node of c, which hangs on node 4
  EXPECT_EQ(staleBefore(change), (Nodes{3, 4, 5, 6, 7, 16}));
}

TEST(MoveNode, TakesNeighboursTheirPointsInItsSection) {
  Case value = smallTree();
  value.points->position[2 * 6].x = 2.55F;  // of node 6, in the section of node 5
  moveNode(value, 5, {2.5, 0, 0}, 1.2);
  EXPECT_EQ(value.points->position.size(), 2U * 25 - 1);
}

TEST(MoveNode, LeavesTheWallOfASac) {
  Case value = smallTree();
  value.tree.branches[1].kind = BranchKind::Aneurysm;
  moveNode(value, 13, {6.5, 0, 0.5}, 2);
  EXPECT_EQ(value.points, smallTree().points);
  EXPECT_EQ(value.tree.radius[13], 2);
}

TEST(MoveNode, RefusesWhatIsNoPlace) {
  for (const double radius : {0.0, -1.0, 1e-60, std::nan("")})
    EXPECT_NE(refusal(smallTree(),
                      [&](Case& c) {
                        moveNode(c, 5, {0, 0, 0}, radius);
                      })
                  .find("a radius above 0"),
              std::string::npos);
  EXPECT_NE(refusal(smallTree(),
                    [](Case& c) {
                      moveNode(c, 5, {1e30, 0, 0}, 1);
                    })
                .find("within a kilometre"),
            std::string::npos);
}

TEST(Edits, AreRecordedInOneStepInTheirOrder) {
  Case value = smallTree();
  renameBranch(value, 0, "trunk");
  cutBefore(value, 7);
  ASSERT_EQ(value.metadata.steps.size(), 1U);
  const auto& step = value.metadata.steps[0];
  EXPECT_EQ(step.name, "edit");
  ASSERT_EQ(step.parameters.size(), 2U);
  EXPECT_EQ(std::get<std::string>(step.parameters.at("0001")), "renamed \"a\" to \"trunk\"");
  EXPECT_EQ(std::get<std::string>(step.parameters.at("0002")),
            "cut \"trunk\" before its node 8; the rest is \"trunk-2\"");
}

TEST(Edits, AreRefusedWhereThereIsNoRoomToRecordThem) {
  formats::Metadata metadata;
  metadata.steps.assign(1024, {"fit", "lumen", {}});
  EXPECT_THROW(recordEdit(metadata, "renamed"), Error);
  metadata.steps.back() = {"edit", "lumen", {}};
  recordEdit(metadata, "renamed");
  EXPECT_EQ(metadata.steps.size(), 1024U);
}

TEST(Edits, KeepValuesOfExtensionsWithTheirNodesAndDropWhatMayBeWrong) {
  Case value = formats::test::fullCase();
  ASSERT_GE(value.nodeArrays.size(), 2U);
  const auto old = std::get<std::vector<std::int32_t>>(value.nodeArrays[1].values);
  const Change change = reverseBranch(value, 0);
  ASSERT_EQ(value.nodeArrays.size(), 2U);
  const auto& now = std::get<std::vector<std::int32_t>>(value.nodeArrays[1].values);
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_EQ(now[i], old[change.before[i]]);
  ASSERT_EQ(value.otherChunks.size(), 1U);
  EXPECT_TRUE(value.otherChunks[0].independent);
}

TEST(Edits, SayWhichValuesOfExtensionsNewNodesHaveMadeThemDrop) {
  Case value = smallTree();
  value.metadata.extensionsUsed = {"ACME_flow"};
  value.nodeArrays.push_back({"ACME_flow.speed", 1, "", std::vector<float>(26, 1)});
  EXPECT_TRUE(cutBefore(value, 7).droppedArrays.empty());
  EXPECT_EQ(joinBranch(value, 1, 0).droppedArrays, std::vector<std::string>{"ACME_flow.speed"});
}

}  // namespace
}  // namespace lumen::convert
