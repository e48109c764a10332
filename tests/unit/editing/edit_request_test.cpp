// SPDX-License-Identifier: Apache-2.0
// Corrections that a case keeps, made again in another case of the same vessels.
#include "converters/stages/editing/edit_request.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"
#include "unit/formats/sample_case.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// Vessels "a", "b" on its end, "c" beside, of radius 1; `shift`: mm along x, as of another track.
Case tracked(float shift, const std::string& prefix = "") {
  Case value = formats::test::noBeads();
  addBeads(value, prefix + "a", alongX(shift, 0.5F, 11), 1);
  addBeads(value, prefix + "b", alongX(5.5F + shift, 0.5F, 5), 1, 10);
  addBeads(value, prefix + "c", alongX(shift, 0.5F, 9, 8), 1);
  return value;
}

std::vector<std::string> labelsIn(const Case& value) {
  std::vector<std::string> labels;
  for (const auto& branch : value.tree.branches) labels.push_back(branch.label);
  return labels;
}

EditRequest ofBranch(const std::string& op, std::uint32_t branch, const std::string& word = "") {
  EditRequest request;
  request.op = op;
  request.branch = branch;
  request.word = word;
  return request;
}

EditRequest ofNode(const std::string& op, std::uint32_t node) {
  EditRequest request;
  request.op = op;
  request.node = node;
  return request;
}

}  // namespace

TEST(EditRequest, EachSentenceKeepsItsRequest) {
  Case value = tracked(0);
  applyEdit(value, ofBranch("rename", 0, "trunk"));
  applyEdit(value, ofNode("cut", 4));
  const auto edits = recordedEdits(value.metadata);
  ASSERT_EQ(edits.size(), 2U);
  EXPECT_NE(edits[0].request.find("\"op\":\"rename\""), std::string::npos) << edits[0].request;
  EXPECT_NE(edits[1].request.find("\"op\":\"cut\""), std::string::npos);
  EXPECT_TRUE(value.metadata.steps.back().parameters.contains("0002"));
  EXPECT_TRUE(hasEdits(value.metadata));
  EXPECT_FALSE(hasEdits(tracked(0).metadata));
}

TEST(EditRequest, EveryKindIsMadeAgainInTheSameCase) {
  EditRequest move = ofNode("move", 3), widen = ofNode("widen", 5);
  move.position = {1.5, 0.2, 0};
  move.radius = widen.radius = 1.1;
  widen.reach = 1;
  for (const EditRequest& request :
       {ofBranch("delete", 2), ofBranch("delete", 0, "go"), ofNode("cut", 4), ofBranch("merge", 1),
        ofBranch("reverse", 2), ofBranch("root", 1), ofBranch("rename", 1, "x"),
        ofBranch("kind", 2, "aneurysm"), ofNode("node_add", 3), ofNode("node_delete", 3), move,
        widen}) {
    Case corrected = tracked(0), again = tracked(0);
    applyEdit(corrected, request);
    const ReplayedEdits done = replayEdits(corrected, again);
    EXPECT_EQ(done.made.size(), 1U) << request.op;
    EXPECT_TRUE(done.left.empty()) << request.op << ": " << done.left.front().why;
    EXPECT_EQ(corrected, again) << request.op;
  }
}

TEST(EditRequest, NamesOfReleasedFilesAreRead) {
  const auto tree = tracked(0).tree;
  for (const auto& [old, name] : std::map<std::string, std::string>{
           {"nodeAdd", "node_add"}, {"nodeDelete", "node_delete"}, {"cut", "cut"}})
    EXPECT_EQ(requestInTree(textOfRequest(ofNode(old, 3), tree), tree).op, name);
}

TEST(EditRequest, APlaceIsFoundWhereTracksAreALittleElsewhere) {
  Case corrected = tracked(0);
  applyEdit(corrected, ofBranch("rename", 0, "trunk"));
  applyEdit(corrected, ofBranch("delete", 2));
  Case again = tracked(0.7F, "vessel-");  // other labels, too
  const ReplayedEdits done = replayEdits(corrected, again);
  EXPECT_TRUE(done.left.empty());
  EXPECT_EQ(labelsIn(again), (std::vector<std::string>{"trunk", "vessel-b"}));
  EXPECT_TRUE(formats::validate(again));
}

TEST(EditRequest, ACorrectionWithoutItsVesselIsLeftAndKept) {
  Case corrected = tracked(0);
  applyEdit(corrected, ofBranch("delete", 2));
  applyEdit(corrected, ofBranch("rename", 0, "trunk"));
  Case again = formats::test::noBeads();
  addBeads(again, "a", alongX(0, 0.5F, 11), 1);
  const ReplayedEdits done = replayEdits(corrected, again);
  ASSERT_EQ(done.left.size(), 1U);
  EXPECT_NE(done.left[0].sentence.find("deleted"), std::string::npos);
  EXPECT_NE(done.left[0].why.find("no vessel lies within 2.0 mm of (2.0, 8.0, 0.0)"),
            std::string::npos)
      << done.left[0].why;
  EXPECT_EQ(labelsIn(again), std::vector<std::string>{"trunk"});
  // the case keeps it, and the vessel is found again later
  Case later = tracked(0);
  const ReplayedEdits once = replayEdits(again, later);
  EXPECT_TRUE(once.left.empty());
  EXPECT_EQ(labelsIn(later), (std::vector<std::string>{"trunk", "b"}));
}

TEST(EditRequest, AChangeWithoutARequestIsLeftUnlessItIsThere) {
  Case corrected = tracked(0), again = tracked(0);
  recordEdit(corrected.metadata, "accepted 2 vessels");
  recordEdit(corrected.metadata, "named 1 vessel as seeds state");
  recordEdit(again.metadata, "named 1 vessel as seeds state");
  ReplayedEdits done = replayEdits(corrected, again);
  ASSERT_EQ(done.left.size(), 1U);
  EXPECT_EQ(done.left[0].sentence, "accepted 2 vessels");
  Case later = tracked(0);
  done = replayEdits(again, later);
  ASSERT_EQ(done.left.size(), 2U);
  EXPECT_EQ(done.left[1].sentence, "accepted 2 vessels");  // no mark comes twice
}

TEST(EditRequest, ACorrectionThatBreaksARuleIsLeft) {
  Case corrected = tracked(0), again = tracked(0);
  applyEdit(corrected, ofBranch("rename", 1, "x"));
  applyEdit(again, ofBranch("rename", 2, "x"));
  const ReplayedEdits done = replayEdits(corrected, again);
  ASSERT_EQ(done.left.size(), 1U);
  EXPECT_TRUE(formats::validate(again));
}

TEST(EditRequest, IsRefusedWithTheReason) {
  Case value = tracked(0);
  EXPECT_THROW(applyEdit(value, ofBranch("explode", 0)), Error);
  EXPECT_THROW(applyEdit(value, ofNode("delete", 0)), Error);
  EXPECT_THROW(applyEdit(value, ofBranch("kind", 0, "vein")), Error);
  EXPECT_EQ(value, tracked(0));
}

}  // namespace lumen::convert
