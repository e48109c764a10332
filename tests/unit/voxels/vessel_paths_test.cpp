// SPDX-License-Identifier: Apache-2.0
// Vessels one voxel wide: a trunk along x, and a branch that leaves it and comes back beside it.
#include "converters/voxels/vessel_paths.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/voxels/depth.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kFork = 20, kBeside = 4, kTip = 3;

struct Vessels {
  VolumeGeometry geometry;
  std::vector<std::size_t> indices;
  Vessels() {
    geometry.size = {62, 8, 3};
    for (int x = 0; x <= 60; ++x) add({x, 1, 1});
    for (int y = 2; y <= kBeside; ++y) add({kFork, y, 1});
    for (int x = kFork - 1; x >= kTip; --x) add({x, kBeside, 1});
    std::sort(indices.begin(), indices.end());
  }
  void add(const Cell& cell) { indices.push_back(geometry.index(cell)); }
  /// The paths from the trunk's end at x = 0.
  [[nodiscard]] std::vector<VesselPath> paths(const VesselPaths::IsOpen& isOpen) const {
    const VoxelSet set(geometry, indices);
    const std::vector<float> depths(set.size(), 0.5F);
    VesselPaths paths(set, depths, isOpen, Progress());
    return paths.find(set.find(geometry.index({0, 1, 1})), Progress());
  }
};

/// No wall.
bool open(const Vector3d&, const Vector3d&) {
  return true;
}

/// A wall between the trunk and what comes back beside it.
bool walled(const Vector3d& a, const Vector3d& b) {
  const bool crosses = (a.y() < 2.5) != (b.y() < 2.5);
  return !crosses || std::max(a.x(), b.x()) >= kFork - 1;
}

TEST(VesselPaths, ATipThatComesBackToItsTrunkClosesALoop) {
  const std::vector<VesselPath> paths = Vessels().paths(open);
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_EQ(paths[0].voxels.size(), 61U);
  EXPECT_EQ(paths[1].parent, 0U);
  EXPECT_EQ(paths[1].parentVoxel, static_cast<std::size_t>(kFork - 1)) << "a diagonal step";
  EXPECT_EQ(paths[1].meets, 0U);
  EXPECT_EQ(paths[1].meetsVoxel, static_cast<std::size_t>(kTip));
}

TEST(VesselPaths, ATipThatComesRoundBehindAWallClosesNone) {
  const std::vector<VesselPath> paths = Vessels().paths(walled);
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_EQ(paths[1].parent, 0U);
  EXPECT_EQ(paths[1].meets, VesselPath::kNone);
}

TEST(VesselPaths, TheFarthestVoxelIsTheTrunksOtherEnd) {
  const Vessels vessels;
  const VoxelSet set(vessels.geometry, vessels.indices);
  const std::vector<float> depths(set.size(), 0.5F);
  const VesselPaths::IsOpen isOpen = open;
  VesselPaths paths(set, depths, isOpen, Progress());
  const std::uint32_t start = set.find(vessels.geometry.index({0, 1, 1}));
  EXPECT_EQ(set.cell(paths.farthest(start, Progress())), Cell(60, 1, 1));
  EXPECT_EQ(paths.connectedPart(start).size(), set.size());
}

/// A trunk along x, eleven voxels wide, from a face of the volume to `end`, and a longer branch of
/// five that leaves it along y before.
std::vector<VesselPath> pathsOfFork(int end) {
  VolumeGeometry geometry;
  geometry.size = {60, 90, 15};
  std::vector<std::size_t> indices;
  for (int z = 0; z < 15; ++z)
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 60; ++x) {
        const bool isTrunk = x < end && std::hypot(y - 8, z - 7) <= 5.5;
        const bool isBranch = y > 8 && y < 85 && std::hypot(x - 38, z - 7) <= 2.5;
        if (isTrunk || isBranch) indices.push_back(geometry.index({x, y, z}));
      }
  const VoxelSet set(geometry, indices);
  const std::vector<float> depths = measureDepths(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, Progress());
  const VesselPaths::IsOpen isOpen = open;
  VesselPaths paths(set, depths, isOpen, Progress());
  return paths.find(set.find(geometry.index({0, 8, 7})), Progress());
}

TEST(VesselPaths, ATrunkBehindALongerBranchIsNoSac) {
  for (const int end : {60, 54}) {
    const std::vector<VesselPath> paths = pathsOfFork(end);
    ASSERT_EQ(paths.size(), 2U) << end;
    EXPECT_FALSE(paths[1].isSac) << end;
  }
}

}  // namespace
}  // namespace lumen::convert
