// SPDX-License-Identifier: Apache-2.0
// Seeds in a case.
#include "converters/io/seeds/case_seeds.h"

#include <string>

#include <gtest/gtest.h>

#include "fixtures.h"
#include "formats/case/case_encoding.h"
#include "formats/case/validate.h"

namespace lumen::convert {
namespace {

/// One node, of the vessel "ica".
formats::Case oneNode() {
  formats::Case value;
  value.tree.centre = {{1, 2, 3}};
  value.tree.direction = {{0, 0, 1}};
  value.tree.radius = {1};
  value.tree.height = {0.5F};
  value.tree.parent = {formats::kNoParent};
  value.tree.branch = {0};
  value.tree.branches.resize(1);
  value.tree.branches[0].label = "ica";
  value.tree.branches[0].nodeCount = 1;
  return value;
}

SeedBranch seed(const std::string& label, const std::optional<std::string>& parent = {}) {
  SeedBranch out;
  out.label = label;
  out.parent = parent;
  out.points.push_back({{0.1, -2.0000000000000004, 1e-17}, 1.5});
  return out;
}

/// A chunk of seeds with that text.
formats::Case withText(const std::string& text) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a")});
  auto& chunk = value.otherChunks.front();
  chunk.bytes.clear();
  for (const char c : text) chunk.bytes.push_back(static_cast<std::byte>(c));
  chunk.rawSize = chunk.bytes.size();
  return value;
}

TEST(CaseSeeds, ACaseWithoutThemHasNone) {
  EXPECT_TRUE(seedsOf(oneNode(), "c").empty());
}

TEST(CaseSeeds, AllOfASeedComesBackFromBothEncodings) {
  formats::Case value = oneNode();
  SeedBranch tracked = seed("ica");
  tracked.isTracked = true;
  tracked.direction = Eigen::Vector3d(0, 0.6, 0.8);
  SeedBranch sac = seed("sac", "ica");
  sac.kind = formats::BranchKind::Aneurysm;
  SeedBranch root = seed("root");
  root.isRoot = true;
  setSeeds(value, {tracked, sac, root});
  ASSERT_TRUE(formats::validate(value));
  const std::vector<std::byte> bytes = formats::encodeBinary(value, {});
  const auto fromBinary = formats::decodeBinary(bytes);
  const auto fromJson = formats::decodeJson(formats::encodeJson(value));
  ASSERT_TRUE(fromBinary && fromJson);
  EXPECT_EQ(formats::encodeBinary(*fromJson, {}), bytes);
  for (const formats::Case& read : {*fromBinary, *fromJson}) {
    const auto seeds = seedsOf(read, "c");
    ASSERT_EQ(seeds.size(), 3U);
    EXPECT_EQ(seeds[0].points[0].position, tracked.points[0].position);
    EXPECT_EQ(seeds[0].points[0].radius, 1.5);
    EXPECT_TRUE(seeds[0].isTracked && !seeds[1].isTracked);
    EXPECT_TRUE(seeds[0].direction->isApprox(*tracked.direction, 1e-15));
    EXPECT_EQ(seeds[1].parent, "ica");
    EXPECT_EQ(seeds[1].kind, formats::BranchKind::Aneurysm);
    EXPECT_TRUE(seeds[2].isRoot);
  }
}

TEST(CaseSeeds, AreReplacedAndRemoved) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a"), seed("b")});
  setSeeds(value, {seed("c")});
  ASSERT_EQ(seedsOf(value, "c").size(), 1U);
  setSeeds(value, {});
  EXPECT_TRUE(value.otherChunks.empty());
}

TEST(CaseSeeds, SurviveAChangeOfTheTree) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a")});
  formats::dropDependentChunks(value);
  EXPECT_EQ(seedsOf(value, "c").size(), 1U);
}

TEST(CaseSeeds, AVesselOfTheCaseIsAParentAndOneThatIsGoneIsNone) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a", "ica"), seed("b", "gone")});
  const auto seeds = seedsOf(value, "c");
  EXPECT_EQ(seeds[0].parent, "ica");
  EXPECT_FALSE(seeds[1].parent);
  auto file = seeds;
  dropOtherParents(file);
  EXPECT_FALSE(file[0].parent);
}

TEST(CaseSeeds, ThoseThatBreakARuleAreRefusedWithTheirPlace) {
  expectRefused(refusal([] { (void)seedsOf(withText("{}"), "c.lumen"); }),
                {"c.lumen: its seeds", "format"});
  expectRefused(refusal([] { (void)seedsOf(withText(""), "c.lumen"); }), {"c.lumen: its seeds"});
  const std::string cycle =
      R"({"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
          "branches": [{"label": "a", "parent": "b", "points": [[1, 2, 3]]},
                       {"label": "b", "parent": "a", "points": [[1, 2, 3]]}]})";
  expectRefused(refusal([&] { (void)seedsOf(withText(cycle), "c.lumen"); }), {"its own ancestor"});
  formats::Case other = oneNode();
  setSeeds(other, {seed("a")});
  other.otherChunks[0].version = 2;
  expectRefused(refusal([&] { (void)seedsOf(other, "c.lumen"); }), {"version 2"});
}

TEST(CaseSeeds, SeedsThatStartedNothingWait) {
  formats::Case value = oneNode();
  setSeeds(value, markTracked({seed("a"), seed("b"), seed("c")}, {{"b", "no vessel"}}));
  const SeedCounts counts = countSeeds(value, "c");
  EXPECT_EQ(counts.tracked, 2U);
  EXPECT_EQ(counts.waiting, 1U);
}

}  // namespace
}  // namespace lumen::convert
