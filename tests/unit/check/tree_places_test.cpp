// SPDX-License-Identifier: Apache-2.0
// Places of a tree that need a look whatever its volume shows.
#include "converters/judge/check/tree_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "../mesh/synthetic.h"
#include "converters/judge/check/shared_lumen.h"
#include "converters/judge/check/skeleton_paths.h"
#include "converters/voxels/depth.h"

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

/// A vessel of radius 2 along z, and one of radius 1 across it that passes its axis at a distance.
formats::Case crossing(double apart) {
  formats::Case value;
  addVessel(value, "wide", straightPath({0, 0, 0}, {0, 0, 1}, 41), 2.0, 1.0);
  addVessel(value, "across", straightPath({-20, apart, 20}, {1, 0, 0}, 41), 1.0, 1.0);
  return value;
}

TEST(SharedLumen, IsWhereTwoTubesOverlapDeeperThanTheTolerance) {
  const auto shared = findSharedLumen(crossing(1.5).tree, 0.5);
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_NEAR(shared[0].depth, 1.5, 1e-5) << "2 + 1 - 1.5";
  EXPECT_NEAR(shared[0].share, 0.75, 1e-5) << "of a diameter of 2";
  EXPECT_EQ(shared[0].node, 20U);
  EXPECT_EQ(shared[0].branch, 0U);
  EXPECT_EQ(shared[0].other, 1U);
  // nodes at 0, 1 and 2 mm from the place are 1.5, 1.80 and 2.5 mm apart, and 2.5 is all that the tolerance allows
  EXPECT_NEAR(shared[0].length, 3, 1e-5);
  EXPECT_TRUE(findSharedLumen(crossing(2.6).tree, 0.5).empty()) << "they touch";
}

TEST(SharedLumen, IsNoJointAndNoForkThatOpensAt30Degrees) {
  formats::Case linked = crossing(1.5);
  linked.tree.links.push_back({20, 41 + 20});
  EXPECT_TRUE(findSharedLumen(linked.tree, 0.5).empty());
  for (const double degrees : {30.0, 10.0}) {
    formats::Case fork;
    addVessel(fork, "parent", straightPath({0, 0, 0}, {0, 0, 0.5}, 81), 1.0, 1.0);
    const double angle = degrees * std::numbers::pi / 180;
    const Eigen::Vector3d along(std::sin(angle), 0, std::cos(angle));
    addVessel(fork, "child", straightPath(Eigen::Vector3d(0, 0, 5) + 0.5 * along, 0.5 * along, 40),
              1.0, 1.0, 10);
    const auto shared = findSharedLumen(fork.tree, 0.25);
    EXPECT_EQ(shared.size(), degrees < 29 ? 1U : 0U);
    // the overlap ends 10 mm behind the fork, where the axes are 1.75 mm apart; 3.5 mm behind it the
    // child still reaches nodes of the parent at 5 mm, over a path of more than 8 mm
    if (!shared.empty()) {
      EXPECT_NEAR(shared[0].length, 7, 1e-3);
    }
  }
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

// Voxels that a person can count.
VolumeGeometry gridOf(int edge, double spacing) {
  VolumeGeometry geometry;
  geometry.size = {edge, edge, edge};
  geometry.spacing.setConstant(spacing);
  return geometry;
}

std::vector<SkeletonPath> pathsOf(const VoxelSet& set, std::size_t root, std::size_t least) {
  const std::vector<float> depths = measureDepths(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, Progress());
  std::vector<std::uint8_t> free(set.size(), 1);
  std::vector<SkeletonPath> paths;
  SkeletonPaths skeleton(set, depths, free);
  skeleton.split(set.find(root), 4 * set.geometry().voxelSize(), least, Progress(), paths);
  return paths;
}

/// Twenty voxels in a row, and ten more across it from its middle.
std::vector<std::size_t> fork(const VolumeGeometry& geometry) {
  std::vector<std::size_t> voxels;
  for (int x = 0; x < 20; ++x) voxels.push_back(geometry.index({x, 2, 2}));
  for (int y = 3; y < 13; ++y) voxels.push_back(geometry.index({9, y, 2}));
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST(SkeletonPaths, AForkHasTwoPaths) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  const auto paths = pathsOf(set, geometry.index({0, 2, 2}), 20);
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_NEAR(paths[0].length, 20 * 0.3, 0.3);
  EXPECT_EQ(set.index(paths[0].voxels.front()), geometry.index({0, 2, 2}));
  EXPECT_EQ(set.index(paths[0].voxels.back()), geometry.index({19, 2, 2}));
  // less what the first path covers: two voxels and three quarters
  EXPECT_NEAR(paths[1].length, 8 * 0.3, 0.35);
  EXPECT_EQ(set.index(paths[1].voxels.back()), geometry.index({9, 12, 2}));
  EXPECT_EQ(paths[0].covered + paths[1].covered, 30U);
}

TEST(SkeletonPaths, ASpeckHasNone) {
  const VolumeGeometry geometry = gridOf(20, 0.3);
  const VoxelSet set(geometry, fork(geometry));
  EXPECT_TRUE(pathsOf(set, geometry.index({0, 2, 2}), 31).empty());
}

}  // namespace
}  // namespace lumen::convert
