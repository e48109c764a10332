// SPDX-License-Identifier: Apache-2.0
// Places of a tree that need a look whatever its volume shows.
#include "converters/judge/check/tree_places.h"

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"

namespace lumen::convert {
namespace {

using test::addVessel;
using test::straightPath;

VolumeGeometry box(int voxels) {
  VolumeGeometry geometry;
  geometry.size = {voxels, voxels, voxels};
  geometry.spacing = {1, 1, 1};
  return geometry;
}

TEST(TreePlaces, ATreeIsLooseUnlessItIsTheLongestOrComesFromOutside) {
  formats::Case value;
  addVessel(value, "long", straightPath({10, 10, 10}, {0, 0, 1}, 21), 1.0, 1.0);
  addVessel(value, "entering", straightPath({20, 20, 1}, {0, 0, 1}, 6), 1.0, 1.0);
  addVessel(value, "short", straightPath({30, 30, 20}, {0, 0, 1}, 4), 1.0, 1.0);
  addVessel(value, "loose", straightPath({30, 10, 20}, {0, 0, 1}, 11), 1.0, 1.0);
  const auto loose = findLooseTrees(value.tree, box(41));
  ASSERT_EQ(loose.size(), 2U);
  EXPECT_EQ(value.tree.branches[value.tree.branch[loose[0].node]].label, "loose");
  EXPECT_EQ(loose[0].branches, 1U);
  EXPECT_NEAR(loose[0].length, 10, 1e-5);
  EXPECT_EQ(value.tree.branches[value.tree.branch[loose[1].node]].label, "short");
}

TEST(TreePlaces, AVesselWithinAnotherIsDoubledButACrossingOrATouchingOneIsNot) {
  formats::Case value;
  addVessel(value, "wide", straightPath({0, 0, 0}, {0, 0, 1}, 41), 2.0, 1.0);
  addVessel(value, "within", straightPath({0.5, 0, 5}, {0, 0, 1}, 15), 1.0, 1.0);
  addVessel(value, "brief", straightPath({0.5, 0, 30}, {0, 0, 1}, 8), 1.0, 1.0);
  addVessel(value, "beside", straightPath({2.8, 0, 0}, {0, 0, 1}, 41), 1.0, 1.0);
  addVessel(value, "across", straightPath({-20, 0, 20}, {1, 0, 0}, 39), 1.0, 1.0);
  const auto doubled = findDoubledTracks(value.tree);
  ASSERT_EQ(doubled.size(), 1U);
  EXPECT_EQ(value.tree.branches[doubled[0].branch].label, "within");
  EXPECT_EQ(value.tree.branches[doubled[0].other].label, "wide");
  EXPECT_NEAR(doubled[0].length, 14, 1e-5);
  EXPECT_EQ(value.tree.branch[doubled[0].node], doubled[0].branch);
}

TEST(TreePlaces, ThreePoorNodesInARowAreAPlace) {
  formats::Case value;
  addVessel(value, "a", straightPath({0, 0, 0}, {0, 0, 1}, 10), 1.0, 1.0);
  addVessel(value, "b", straightPath({9, 0, 0}, {0, 0, 1}, 10), 1.0, 1.0);
  std::vector<Agreement> agreement(20, Agreement::Good);
  for (const std::size_t n : {1U, 2U, 7U, 8U, 9U, 10U, 11U, 15U, 16U, 17U, 18U})
    agreement[n] = Agreement::Poor;
  const auto poor = findPoorStretches(value.tree, agreement);
  ASSERT_EQ(poor.size(), 2U) << "two of one branch, and two of the next, are too few";
  EXPECT_EQ(poor[0].first, 15U);
  EXPECT_EQ(poor[0].end, 19U);
  EXPECT_NEAR(poor[0].length, 3, 1e-5);
  EXPECT_EQ(poor[1].first, 7U);
  EXPECT_EQ(poor[1].end, 10U);
}

}  // namespace
}  // namespace lumen::convert
