// SPDX-License-Identifier: Apache-2.0
// Ends that are too thin or too short, on a case of beads along x, half a millimetre apart.
#include "converters/stages/editing/trim.h"

#include <gtest/gtest.h>

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"
#include "unit/formats/sample_case.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// "a" has nodes 0 to 20 of radius 1 from x = 0 to 10. "b" leaves its node 10 and has 6 nodes of
/// radius 0.5, the last two 0.2. "c" hangs on the last node of "b", 4 nodes of radius 0.2. "d"
/// leaves node 18 of "a", 12 nodes of radius 0.8, so that 1 mm of "a" lies behind it.
Case makeTree() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 21), 1);
  addBeads(value, "b", alongX(5.5F, 0.5F, 6, 2), 1, 10);
  addBeads(value, "c", alongX(8.5F, 0.5F, 4, 2), 1, 26);
  addBeads(value, "d", alongX(9.5F, 0.5F, 12, 3), 1, 18);
  const auto set = [&](std::uint32_t first, std::uint32_t count, float radius) {
    for (std::uint32_t n = first; n < first + count; ++n) value.tree.radius[n] = radius;
  };
  set(0, 21, 1);
  set(21, 4, 0.5F);
  set(25, 6, 0.2F);
  set(31, 12, 0.8F);
  return value;
}

std::vector<std::string> sizes(const Case& value) {
  std::vector<std::string> all;
  for (const auto& branch : value.tree.branches)
    all.push_back(branch.label + " " + std::to_string(branch.nodeCount));
  return all;
}

using Sizes = std::vector<std::string>;

}  // namespace

TEST(Trim, RemovesThinEndsUpToTheFirstNodeThatIsWideEnough) {
  Case value = makeTree();
  const TrimResult trimmed = trimEnds(value, {0.3, 0});
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 4", "d 12"}));
  EXPECT_TRUE(formats::validate(value));
  ASSERT_EQ(trimmed.ends.size(), 2U);
  EXPECT_EQ(trimmed.ends[0].label, "b");
  EXPECT_FALSE(trimmed.ends[0].isWhole);
  EXPECT_EQ(trimmed.ends[0].nodes, 2U);
  EXPECT_NEAR(trimmed.ends[0].length, 1, 1e-6);
  EXPECT_NEAR(trimmed.ends[0].radius, 0.2, 1e-6);
  EXPECT_EQ(trimmed.ends[1].label, "c");
  EXPECT_TRUE(trimmed.ends[1].isWhole);
}

TEST(Trim, RemovesShortEndsBehindTheLastBranchAndWholeBranches) {
  Case value = makeTree();
  trimEnds(value, {0, 1.9});
  // 1 mm of "a" lies behind "d", all of it within the ball there; "c" is 1.8 mm long outside of "b"
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "b 6", "d 12"}));
  trimEnds(value, {0, 4});
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "d 12"}));
}

TEST(Trim, AnEndThatIsShortOnceItsThinPartIsGoneGoesToo) {
  Case value = makeTree();
  trimEnds(value, {0.3, 3});
  EXPECT_EQ(sizes(value), (Sizes{"a 19", "d 12"}));
}

TEST(Trim, KeepsBranchesThatLeadToALink) {
  Case value = makeTree();
  value.tree.links = {{2, 30}};
  EXPECT_TRUE(trimEnds(value, {0.3, 0}).ends.empty());
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 6", "c 4", "d 12"}));
}

TEST(Trim, KeepsAneurysmsAndTheVesselThatTheyHangOn) {
  Case value = makeTree();
  value.tree.branches[2].kind = formats::BranchKind::Aneurysm;
  EXPECT_TRUE(trimEnds(value, {0.3, 0}).ends.empty());
}

TEST(Trim, ATreeOfOneThinVesselGoes) {
  Case value = makeTree();
  const auto first = static_cast<std::uint32_t>(value.tree.nodeCount());
  addBeads(value, "loose", alongX(0, 0.5F, 9, 20), 1);
  for (std::uint32_t n = first; n < first + 9; ++n) value.tree.radius[n] = 0.25F;
  trimEnds(value, {0.3, 0});
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 4", "d 12"}));
}

TEST(Trim, RefusesLimitsThatLeaveNothing) {
  Case value = makeTree();
  EXPECT_THROW(trimEnds(value, {2, 0}), Error);
  EXPECT_EQ(sizes(value), (Sizes{"a 21", "b 6", "c 4", "d 12"}));
}

TEST(Trim, RecordsAnEditUnlessNothingGoes) {
  Case value = makeTree();
  EXPECT_TRUE(trimEnds(value, {0.1, 0}).ends.empty());
  EXPECT_EQ(lastStep(value.metadata, kEditStep), nullptr);
  const TrimResult trimmed = trimEnds(value, {0.3, 1.9});
  EXPECT_EQ(trimmed.change.sentence, "trimmed 3 ends thinner than 0.3 mm or shorter than 1.9 mm");
  EXPECT_NE(lastStep(value.metadata, kEditStep), nullptr);
}

}  // namespace lumen::convert
