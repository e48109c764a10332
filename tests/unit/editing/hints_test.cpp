// SPDX-License-Identifier: Apache-2.0
// Hints on the vessels of cases of beads: names, divisions, parents, roots.
#include "converters/stages/editing/hints.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "converters/base/options/edit_steps.h"
#include "converters/stages/editing/hint_parents.h"
#include "converters/stages/editing/inlets.h"
#include "converters/stages/editing/selection.h"
#include "formats/case/topology.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::kNoParent;
using formats::test::addBeads;
using formats::test::alongX;

/// Places along y from (x, y) on, `step` apart.
std::vector<formats::Vec3f> alongY(float x, float y, float step, int count) {
  std::vector<formats::Vec3f> places;
  for (int i = 0; i < count; ++i) places.push_back({x, y + step * static_cast<float>(i), 0});
  return places;
}

/// A trunk of radius 1 along x from 0 to 20, and branches that leave it at 5 and at 15, upward.
Case comb() {
  Case value = formats::test::noBeads();
  addBeads(value, "vessel-1", alongX(0, 0.5F, 41), 1);
  addBeads(value, "vessel-2", alongY(5, 1.5F, 0.5F, 15), 0.8F, 10);
  addBeads(value, "vessel-3", alongY(15, 1.5F, 0.5F, 15), 0.6F, 30);
  value.models.reset();
  return value;
}

SeedBranch seed(const std::string& label, const Vector3d& place,
                const std::optional<std::string>& parent = {}) {
  SeedBranch hint;
  hint.label = label;
  hint.points.push_back({place, {}});
  hint.parent = parent;
  return hint;
}

const formats::Branch& branch(const Case& value, const std::string& label) {
  const auto at = std::find_if(value.tree.branches.begin(), value.tree.branches.end(),
                               [&](const formats::Branch& b) { return b.label == label; });
  if (at != value.tree.branches.end()) return *at;
  ADD_FAILURE() << "no branch " << label;
  return value.tree.branches[0];
}

std::string parentOf(const Case& value, const std::string& label) {
  const std::int32_t node = branch(value, label).parentNode;
  if (node == kNoParent) return "";
  return value.tree.branches[value.tree.branch[static_cast<std::size_t>(node)]].label;
}

std::vector<formats::Vec3f> sortedCentres(const Case& value) {
  std::vector<formats::Vec3f> centres = value.tree.centre;
  std::sort(centres.begin(), centres.end(), [](const auto& a, const auto& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return centres;
}

TEST(Hints, NameVesselsAndMoveNothing) {
  Case value = comb();
  const auto before = sortedCentres(value);
  const HintRemarks remarks =
      applyHints(value, {seed("ica", {2, 0.3, 0}), seed("mca", {5, 4, 0.2}, "ica")});
  EXPECT_TRUE(formats::validate(value));
  EXPECT_EQ(branch(value, "ica").firstNode, 0U);
  EXPECT_EQ(parentOf(value, "mca"), "ica");
  EXPECT_EQ(sortedCentres(value), before);
  EXPECT_TRUE(remarks.rest.empty() && remarks.unused.empty() && remarks.unjoined.empty());
  EXPECT_NE(lastStep(value.metadata, kEditStep), nullptr);
}

TEST(Hints, TakeTheirNamesFromOtherBranches) {
  Case value = comb();
  applyHints(value, {seed("vessel-3", {5, 4, 0})});
  EXPECT_EQ(value.tree.centre[branch(value, "vessel-3").firstNode].x, 5);
  EXPECT_EQ(value.tree.branches.size(), 3U);
  EXPECT_TRUE(formats::validate(value));
}

TEST(Hints, DivideAVesselAtTheForkNearestToTheSecondOfThem) {
  Case value = comb();
  applyHints(value, {seed("a", {1, 0, 0}), seed("b", {16.5, 0, 0}, "a")});
  // "a" goes on with the branch at 15, as a fork does whose wider child has another name
  EXPECT_EQ(value.tree.centre[branch(value, "b").firstNode].x, 15.5F);
  EXPECT_EQ(branch(value, "a").nodeCount, 31U + 15U);
  EXPECT_EQ(parentOf(value, "b"), "a");
  EXPECT_TRUE(formats::validate(value));
}

TEST(Hints, DivideAVesselWithoutForksInTheMiddle) {
  Case value = formats::test::noBeads();
  addBeads(value, "vessel-1", alongX(0, 0.5F, 21), 1);
  value.models.reset();
  applyHints(value, {seed("a", {1, 0, 0}), seed("b", {9, 0, 0}, "a")});
  EXPECT_NEAR(value.tree.centre[branch(value, "b").firstNode].x, 5, 0.6);
}

TEST(Hints, OfOneNodeAreOneVessel) {
  Case value = comb();
  const HintRemarks remarks = applyHints(value, {seed("a", {1, 0, 0}), seed("b", {1, 0.1, 0})});
  ASSERT_EQ(remarks.unused.size(), 1U);
  EXPECT_EQ(remarks.unused[0].label, "b");
  EXPECT_NE(remarks.unused[0].reason.find("\"a\""), std::string::npos);
}

TEST(Hints, ReportWhereAVesselWithoutForksIsDividedBetweenThem) {
  Case value = formats::test::noBeads();
  addBeads(value, "vessel-1", alongX(0, 0.5F, 21), 1);
  value.models.reset();
  const HintRemarks remarks = applyHints(value, {seed("a", {1, 0, 0}), seed("b", {9, 0, 0})});
  ASSERT_EQ(remarks.halved.size(), 1U);
  EXPECT_EQ(remarks.halved[0].label, "b");
  EXPECT_EQ(remarks.halved[0].reason,
            "\"a\" lies in the same vessel, which no other leaves: it is divided halfway between "
            "both, at (5, 0, 0) mm");
  Case forked = comb();
  EXPECT_TRUE(applyHints(forked, {seed("a", {1, 0, 0}), seed("b", {16.5, 0, 0})}).halved.empty());
}

TEST(Hints, WhoseParentNamesNoVesselAreReportedOnceAllIsTracked) {
  Case value = comb();
  const std::vector<SeedBranch> hints = {seed("a", {1, 0, 0}), seed("lost", {10, -6, 0}, "a"),
                                         seed("b", {5, 4, 0}, "lost")};
  const HintRemarks remarks = applyHints(value, hints);
  EXPECT_TRUE(remarks.unjoined.empty());
  const auto unkept = unkeptParents(value.tree, hints, remarks.holders, remarks.unjoined);
  ASSERT_EQ(unkept.size(), 1U);
  EXPECT_EQ(unkept[0].label, "b");
  EXPECT_EQ(unkept[0].reason, "\"lost\" names no vessel; it hangs on \"a\"");
  EXPECT_TRUE(unkeptParents(value.tree, hints, remarks.holders, unkept).empty());
}

TEST(Hints, OfATreeApartFromTheStatedParentAreReportedWithTheGap) {
  Case value = comb();
  addBeads(value, "apart", alongX(0, 0.5F, 9, -6), 0.5F);
  const auto unkept = unkeptParents(
      value.tree, {seed("vessel-1", {0, 0, 0}), seed("apart", {0, -6, 0}, "vessel-1")}, {}, {});
  ASSERT_EQ(unkept.size(), 1U);
  EXPECT_EQ(unkept[0].reason,
            "\"vessel-1\" ends 4.5 mm from it, by the walls; it begins a tree of its own");
}

TEST(Hints, ThatShareAVesselWithAParentHangOnItsHolder) {
  Case value = comb();
  const std::vector<SeedBranch> hints = {seed("a", {1, 0, 0}), seed("twin", {1, 0.1, 0}),
                                         seed("b", {5, 4, 0}, "twin")};
  const HintRemarks remarks = applyHints(value, hints);
  EXPECT_EQ(remarks.holders.at("twin"), "a");
  EXPECT_TRUE(unkeptParents(value.tree, hints, remarks.holders, {}).empty());
}

TEST(Hints, OfKindRootAtOneEndAreReported) {
  Case value = comb();
  SeedBranch first = seed("inlet", {1, 0, 0}), second = seed("again", {3, 0, 0});
  first.isRoot = second.isRoot = true;
  const HintRemarks remarks = applyHints(value, {first, second});
  ASSERT_EQ(remarks.unrooted.size(), 1U);
  EXPECT_EQ(remarks.unrooted[0].label, "again");
}

TEST(Hints, OutsideOfAllVesselsAreTheRest) {
  Case value = comb();
  const HintRemarks remarks =
      applyHints(value, {seed("a", {1, 0, 0}), seed("lost", {10, -6, 0}, "a")});
  ASSERT_EQ(remarks.rest.size(), 1U);
  EXPECT_EQ(remarks.rest[0].label, "lost");
  EXPECT_FALSE(remarks.rest[0].parent) << "the lumen shows it";
}

TEST(Hints, ACourseMostOfWhichIsInNoVesselIsTheRest) {
  Case value = comb();
  SeedBranch course = seed("a", {1, 0, 0});
  for (const double y : {-4.0, -6.0, -8.0}) course.points.push_back({{1, y, 0}, {}});
  EXPECT_EQ(applyHints(value, {course}).rest.size(), 1U);
}

TEST(Hints, OfTwoVesselsTheRadiusDecides) {
  Case value = formats::test::noBeads();
  addBeads(value, "wide", alongX(0, 0.5F, 21), 2);
  addBeads(value, "thin", alongX(0, 0.5F, 21, 1.5F), 0.5F);
  value.models.reset();
  SeedBranch hint = seed("a", {5, 1.2, 0});
  hint.points[0].radius = 1.9;
  applyHints(value, {hint});
  EXPECT_EQ(branch(value, "a").firstNode, 0U);
}

/// Two vessels with a gap of `gap` mm between them, the second clicked as a child of the first.
HintRemarks acrossGap(Case& value, float gap) {
  value = formats::test::noBeads();
  addBeads(value, "vessel-1", alongX(0, 0.5F, 21), 1);
  addBeads(value, "vessel-2", alongX(10 + gap, 0.5F, 9), 1);
  value.models.reset();
  return applyHints(value, {seed("a", {1, 0, 0}), seed("b", {12 + gap, 0, 0}, "a")});
}

TEST(Hints, JoinAVesselToItsParentAcrossAGapThatIsShorterThanIt) {
  Case value;
  EXPECT_TRUE(acrossGap(value, 3).unjoined.empty());
  EXPECT_EQ(parentOf(value, "b"), "a");
  const HintRemarks far = acrossGap(value, 5);
  ASSERT_EQ(far.unjoined.size(), 1U);
  EXPECT_NE(far.unjoined[0].reason.find("5.0 mm"), std::string::npos) << far.unjoined[0].reason;
  EXPECT_EQ(parentOf(value, "b"), "");
}

TEST(Hints, AVesselThatHangsOnAnotherThanItsParentStaysThere) {
  Case value = comb();
  const HintRemarks remarks = applyHints(
      value, {seed("a", {1, 0, 0}), seed("b", {5, 4, 0}, "a"), seed("c", {15, 4, 0}, "b")});
  ASSERT_EQ(remarks.unjoined.size(), 1U);
  EXPECT_EQ(remarks.unjoined[0].label, "c");
  EXPECT_EQ(parentOf(value, "c"), "a");
}

TEST(Hints, ARootIsWhereTheHintOfThatKindLies) {
  Case value = comb();
  SeedBranch root = seed("inlet", {15, 7, 0});
  root.isRoot = true;
  applyHints(value, {root});
  EXPECT_EQ(value.tree.branches[0].label, "inlet");
  EXPECT_EQ(value.tree.centre[0].y, 8.5F);
  EXPECT_EQ(parentOf(value, "inlet"), "");
  EXPECT_TRUE(formats::validate(value));
}

TEST(BeginAt, DividesATreeBetweenTwoInletsAtItsNarrowestNode) {
  Case value = comb();
  value.tree.radius[20] = 0.4F;  // on the trunk, between the branches
  const std::vector<Vector3d> places = {{0.5, 0, 0}, {19.5, 0, 0}};
  EXPECT_TRUE(beginAt(value, places).empty());
  EXPECT_TRUE(formats::validate(value));
  std::vector<float> roots;
  for (const formats::Branch& b : value.tree.branches)
    if (b.parentNode == kNoParent) roots.push_back(value.tree.centre[b.firstNode].x);
  std::sort(roots.begin(), roots.end());
  EXPECT_EQ(roots, (std::vector<float>{0, 20}));
  ASSERT_EQ(value.tree.links.size(), 1U);
  const auto [a, b] = value.tree.links[0];
  EXPECT_NEAR(std::abs(value.tree.centre[a].x - value.tree.centre[b].x), 0.5, 1e-6);
  EXPECT_NEAR(value.tree.centre[a].x, 10, 0.6);
}

TEST(BeginAt, ReturnsPlacesInNoVessel) {
  Case value = comb();
  const std::vector<Vector3d> places = {{0.5, 0, 0}, {9, 9, 9}};
  const std::vector<UnusedPlace> unused = {{1, UnusedPlace::Why::InNoVessel}};
  EXPECT_EQ(beginAt(value, places), unused);
}

TEST(BeginAt, ReturnsPlacesWhoseEndAnEarlierOneHas) {
  Case value = comb();
  const std::vector<Vector3d> places = {{0.5, 0, 0}, {1.5, 0, 0}};
  const std::vector<UnusedPlace> unused = {{1, UnusedPlace::Why::SameEnd}};
  EXPECT_EQ(beginAt(value, places), unused);
}

TEST(BeginAt, ReturnsPlacesBeforeWhichNothingCanBeDivided) {
  Case value = formats::test::noBeads();
  addBeads(value, "short", alongX(0, 1.5F, 2), 1);
  value.models.reset();
  const std::vector<Vector3d> places = {{0, 0, 0}, {1.5, 0, 0}};
  const std::vector<UnusedPlace> unused = {{1, UnusedPlace::Why::NotDivided}};
  EXPECT_EQ(beginAt(value, places), unused);
}

TEST(NearestVessel, IsThatWhoseWallIsNearest) {
  const Case value = comb();
  const auto beside = nearestVessel(value.tree, {10, -3, 0});
  ASSERT_TRUE(beside);
  EXPECT_EQ(value.tree.branches[beside->branch].label, "vessel-1");
  EXPECT_NEAR(beside->toWall, 2, 1e-6);
  EXPECT_LT(nearestVessel(value.tree, {5, 5, 0})->toWall, 0);
  EXPECT_FALSE(nearestVessel(formats::test::noBeads().tree, {0, 0, 0}));
}

TEST(Selection, KeepsTheTreesOfNamedBranches) {
  Case value = comb();
  addBeads(value, "other", alongX(0, 0.5F, 9, 30), 1);
  value.models.reset();
  Case connected = value;
  leaveOutBranches(connected, unconnectedWith(connected.tree, {"vessel-3"}));
  EXPECT_EQ(connected.tree.branches.size(), 3U);
}

}  // namespace
}  // namespace lumen::convert
