// SPDX-License-Identifier: Apache-2.0
// Inlets that widths show, on cases of beads.

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/stages/editing/inlets.h"
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
bool isInside(const Vector3d& point) {
  return point.z() > 0;
}

std::vector<Vec3f> places(const Vector3d& from, const Vector3d& to, int count) {
  std::vector<Vec3f> out;
  for (int i = 0; i < count; ++i) out.push_back(toVec3f(from + (to - from) * i / (count - 1.0)));
  return out;
}

/// Two vessels upward from the lower face, 10 mm apart, and one of another radius between them, as
/// a tree from the first vessel's lower end.
Case bridgedPair(float between) {
  Case value = formats::test::noBeads();
  addBeads(value, "left", places({0, 0, 1}, {0, 0, 21}, 21), 2);
  addBeads(value, "across", places({2.5, 0, 11}, {9.5, 0, 11}, 15), between, 10);
  addBeads(value, "up", places({10, 0, 12}, {10, 0, 21}, 10), 2, 35);
  addBeads(value, "down", places({10, 0, 10}, {10, 0, 1}, 10), 2, 35);
  value.models.reset();
  return value;
}

TEST(FurtherInlets, AVesselThatFeedsTwoWiderOnesShowsAnotherInlet) {
  const Case value = bridgedPair(0.8F);
  const std::vector<Vector3d> found = furtherInlets(value.tree, isInside);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT((found[0] - Vector3d(0, 0, 1)).norm(), 1e-6);
  EXPECT_LT((found[1] - Vector3d(10, 0, 1)).norm(), 1e-6);
}

TEST(FurtherInlets, TheTreeIsCutWhereItIsNarrowAndBothPartsKeepTheirRoots) {
  Case value = bridgedPair(0.8F);
  EXPECT_TRUE(beginAt(value, furtherInlets(value.tree, isInside)).empty());
  const auto valid = formats::validate(value);
  EXPECT_TRUE(valid) << (valid ? "" : valid.error().text());
  std::vector<Vec3f> roots;
  for (const formats::Branch& branch : value.tree.branches)
    if (branch.parentNode == kNoParent) roots.push_back(value.tree.centre[branch.firstNode]);
  ASSERT_EQ(roots.size(), 2U);
  for (const Vec3f& root : roots) EXPECT_EQ(root.z, 1);
  EXPECT_EQ(value.tree.links.size(), 1U);
}

TEST(FurtherInlets, TheCutLiesInTheMiddleOfAVesselOfEvenWidthWhereverItIsNarrowestByAHair) {
  for (const std::size_t narrowest : {23U, 28U, 33U}) {
    Case value = bridgedPair(0.8F);
    value.tree.radius[narrowest] = 0.799F;
    EXPECT_TRUE(beginAt(value, furtherInlets(value.tree, isInside)).empty());
    ASSERT_EQ(value.tree.links.size(), 1U);
    const auto [a, b] = value.tree.links[0];
    EXPECT_NEAR(0.5 * double{value.tree.centre[a].x + value.tree.centre[b].x}, 6, 0.5) << narrowest;
  }
}

TEST(FurtherInlets, AVesselThatDividesHasOne) {
  EXPECT_TRUE(furtherInlets(bridgedPair(2.2F).tree, isInside).empty());
}

TEST(FurtherInlets, AnEndWithinTheVolumeIsNone) {
  const auto everywhere = [](const Vector3d&) { return true; };
  EXPECT_TRUE(furtherInlets(bridgedPair(0.8F).tree, everywhere).empty());
}

TEST(FurtherInlets, AStenosisBeforeAForkIsNoCommunicatingArtery) {
  Case value = bridgedPair(2.2F);
  for (std::size_t n = 26; n < 30; ++n) value.tree.radius[n] = 0.6F;
  EXPECT_TRUE(furtherInlets(value.tree, isInside).empty());
}

}  // namespace
}  // namespace lumen::convert
