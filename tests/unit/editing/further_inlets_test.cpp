// SPDX-License-Identifier: Apache-2.0
// Inlets that widths show, on cases of beads.
#include "converters/stages/editing/further_inlets.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::kNoParent;
using formats::Vec3f;
using formats::test::addBeads;

/// Vessels leave the volume through its lower face.
bool isAboveFace(const Vector3d& point) {
  return point.z() > 0;
}

std::vector<Vec3f> between(const Vector3d& from, const Vector3d& to, int count) {
  std::vector<Vec3f> out;
  for (int i = 0; i < count; ++i) out.push_back(toVec3f(from + (to - from) * i / (count - 1.0)));
  return out;
}

constexpr std::int32_t kLeftMiddle = 10, kAcrossEnd = 35;  // nodes of the case below

/// Two vessels upward from the lower face, 10 mm apart, and one of another radius between them, as
/// a tree from the first vessel's lower end. `down`: the radius of the second one's lower part.
Case bridgedPair(float across, float down = 2) {
  Case value = formats::test::noBeads();
  addBeads(value, "left", between({0, 0, 1}, {0, 0, 21}, 21), 2);
  addBeads(value, "across", between({2.5, 0, 11}, {9.5, 0, 11}, 15), across, kLeftMiddle);
  addBeads(value, "up", between({10, 0, 12}, {10, 0, 21}, 10), 2, kAcrossEnd);
  addBeads(value, "down", between({10, 0, 10}, {10, 0, 1}, 10), down, kAcrossEnd);
  value.models.reset();
  return value;
}

std::vector<FurtherInlet> inletsOf(Case value) {
  return beginAtFurtherInlets(value, isAboveFace);
}

std::vector<Vec3f> rootCentres(const Case& value) {
  std::vector<Vec3f> roots;
  for (const formats::Branch& branch : value.tree.branches)
    if (branch.parentNode == kNoParent) roots.push_back(value.tree.centre[branch.firstNode]);
  return roots;
}

TEST(FurtherInlets, AVesselThatLeadsToAWiderEndShowsAnotherInlet) {
  const std::vector<FurtherInlet> found = inletsOf(bridgedPair(0.8F));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].centre - Vector3d(10, 0, 1)).norm(), 1e-6);
  EXPECT_NEAR(found[0].radius, 2, 1e-6);
  EXPECT_NEAR(found[0].narrowest, 0.8, 1e-6);
}

TEST(FurtherInlets, AreWiderThanTheVesselBeforeByTheCubeRootOfTwo) {
  for (const float down : {1.1F, 1.25F}) EXPECT_TRUE(inletsOf(bridgedPair(1, down)).empty());
  for (const float down : {1.27F, 1.5F}) EXPECT_EQ(inletsOf(bridgedPair(1, down)).size(), 1U);
}

TEST(FurtherInlets, AThinVesselAtTheForkHidesNone) {
  Case value = bridgedPair(0.8F);
  addBeads(value, "thin", between({10, 1, 11}, {10, 9, 11}, 9), 0.4F, kAcrossEnd);
  value.models.reset();
  EXPECT_EQ(inletsOf(value).size(), 1U);
}

TEST(FurtherInlets, TheTreeIsCutWhereItIsNarrowAndBothPartsKeepTheirRoots) {
  Case value = bridgedPair(0.8F);
  EXPECT_EQ(beginAtFurtherInlets(value, isAboveFace).size(), 1U);
  const auto valid = formats::validate(value);
  EXPECT_TRUE(valid) << (valid ? "" : valid.error().text());
  const std::vector<Vec3f> roots = rootCentres(value);
  ASSERT_EQ(roots.size(), 2U);
  for (const Vec3f& root : roots) EXPECT_EQ(root.z, 1);
  EXPECT_EQ(value.tree.links.size(), 1U);
  EXPECT_TRUE(beginAtFurtherInlets(value, isAboveFace).empty());
}

TEST(FurtherInlets, TheCutLiesInTheMiddleOfAVesselOfEvenWidthWhereverItIsNarrowestByAHair) {
  for (const std::size_t narrowest : {23U, 28U, 33U}) {
    Case value = bridgedPair(0.8F);
    value.tree.radius[narrowest] = 0.799F;
    EXPECT_EQ(beginAtFurtherInlets(value, isAboveFace).size(), 1U);
    ASSERT_EQ(value.tree.links.size(), 1U);
    const auto [a, b] = value.tree.links[0];
    EXPECT_NEAR(0.5 * double{value.tree.centre[a].x + value.tree.centre[b].x}, 6, 0.5) << narrowest;
  }
}

/// A third vessel behind the second one: its end is fed by what the second inlet brings, or by none.
Case bridgedThree(float second) {
  Case value = bridgedPair(0.8F);
  constexpr std::int32_t kUpMiddle = 40;
  addBeads(value, "across-2", between({12.5, 0, 16}, {19.5, 0, 16}, 15), second, kUpMiddle);
  const auto end = static_cast<std::int32_t>(value.tree.nodeCount()) - 1;
  addBeads(value, "up-2", between({20, 0, 17}, {20, 0, 21}, 5), 1.2F, end);
  addBeads(value, "down-2", between({20, 0, 15}, {20, 0, 1}, 15), 1.2F, end);
  value.models.reset();
  return value;
}

TEST(FurtherInlets, AnEndThatAnotherInletFeedsIsNone) {
  EXPECT_EQ(inletsOf(bridgedThree(1.2F)).size(), 1U);
  EXPECT_EQ(inletsOf(bridgedThree(0.7F)).size(), 2U);
}

TEST(FurtherInlets, AVesselThatDividesHasOne) {
  EXPECT_TRUE(inletsOf(bridgedPair(2.2F)).empty());
}

TEST(FurtherInlets, AnEndWithinTheVolumeIsNone) {
  Case value = bridgedPair(0.8F);
  EXPECT_TRUE(beginAtFurtherInlets(value, [](const Vector3d&) { return true; }).empty());
  // twice its radius of 2 from the end at z = 1
  const auto above = [](double face) {
    return [face](const Vector3d& point) { return point.z() > face; };
  };
  EXPECT_TRUE(beginAtFurtherInlets(value, above(-3.3)).empty());
  EXPECT_EQ(beginAtFurtherInlets(value, above(-2.7)).size(), 1U);
}

TEST(FurtherInlets, AStenosisBeforeAForkIsNoCommunicatingArtery) {
  Case value = bridgedPair(2.2F);
  for (std::size_t n = 26; n < 30; ++n) value.tree.radius[n] = 0.6F;
  EXPECT_TRUE(inletsOf(value).empty());
}

TEST(FurtherInlets, AVesselThatOnlyWidensHasOne) {
  Case value = bridgedPair(0.8F);
  for (std::size_t n = 36; n < 46; ++n) value.tree.radius[n] = 0.9F;  // up
  EXPECT_TRUE(inletsOf(value).empty());
  for (std::size_t n = 36; n < 46; ++n) value.tree.radius[n] = 1.1F;
  EXPECT_EQ(inletsOf(value).size(), 1U);
}

/// The lumen of a fork shows no width of the vessel that leads into it: here it is all of the vessel.
TEST(FurtherInlets, AStretchWithinTheLumenOfItsForksShowsNoWidth) {
  Case value = bridgedPair(0.8F);
  EXPECT_EQ(inletsOf(value).size(), 1U);
  value.tree.radius[kLeftMiddle] = 6;
  value.tree.radius[kAcrossEnd] = 6;
  EXPECT_TRUE(inletsOf(value).empty());
}

}  // namespace
}  // namespace lumen::convert
