// SPDX-License-Identifier: Apache-2.0
// Cells, patches and waveform of the target OpenFOAM.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/targets/openfoam/foam_patches.h"
#include "converters/export/targets/openfoam/openfoam_cells.h"
#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

/// A trunk of 4 mm, and `twigs` branches of 0.1 mm that are 100 mm long.
formats::Case withTwigs(int twigs) {
  formats::Case value;
  addBranch(value.tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 101, 4);
  for (int k = 0; k < twigs; ++k)
    addBranch(value.tree, "twig" + std::to_string(k), 10 + k, {5, 0, static_cast<float>(10 + k)},
              {1, 0, 0}, 100, 0.1F);
  return value;
}

FoamPatch patch(const std::string& end, FaceKind kind, double radius) {
  FoamPatch one;
  one.end = one.name = end;
  one.kind = kind;
  one.radius = radius;
  return one;
}

}  // namespace

TEST(FoamCells, LieAcrossEachVesselAsOftenAsThePresetAsks) {
  for (const FoamGrain grain : {FoamGrain::Coarse, FoamGrain::Medium, FoamGrain::Fine}) {
    const FoamCells cells = foamCells(withTwigs(1).tree, grain);
    for (const double radius : {4.0, 1.0, 0.1}) {
      const double across = 2 * radius / cells.edgeAt(cells.level(radius));
      EXPECT_GE(across, cells.across * (1 - 1e-9)) << radius;
      EXPECT_LE(across, 4 * cells.across) << radius;
    }
  }
}

TEST(FoamCells, EndsThatTooManyCellsWouldResolveAreTrimmed) {
  formats::Case few = withTwigs(1), many = withTwigs(60);
  EXPECT_TRUE(trimToCells(few, FoamGrain::Coarse).ends.empty());
  EXPECT_GT(foamCells(many.tree, FoamGrain::Coarse).count, mostCells(FoamGrain::Coarse));
  EXPECT_EQ(trimToCells(many, FoamGrain::Coarse).ends.size(), 60U);
  EXPECT_EQ(many.tree.branches.size(), 1U);
}

TEST(FoamCells, LoopsThatTooManyCellsWouldResolveAreOpenedAndTrimmed) {
  formats::Case few = withTwigs(1), many = withTwigs(60);
  for (formats::Case* one : {&few, &many})
    one->tree.links.push_back({100, 200});  // the ends of the trunk and of a twig
  EXPECT_TRUE(trimToCells(few, FoamGrain::Coarse).links.empty());
  EXPECT_EQ(few.tree.links.size(), 1U);
  const Unresolved gone = trimToCells(many, FoamGrain::Coarse);
  ASSERT_EQ(gone.links.size(), 1U);
  EXPECT_EQ(gone.links[0], (std::array<std::string, 2>{"trunk", "twig0"}));
  EXPECT_EQ(gone.ends.size(), 60U);
  EXPECT_EQ(many.tree.branches.size(), 1U);
}

TEST(FoamPatches, OutletsShareTheFlowByMurray) {
  formats::CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "side", 10, {3, 0, 10}, {1, 0, 0}, 10, 1);
  std::vector<FoamPatch> patches = {
      patch("wall", FaceKind::Wall, 0), patch("inlet", FaceKind::Inlet, 2),
      patch("outlet-trunk", FaceKind::Outlet, 2), patch("outlet-side", FaceKind::Outlet, 1)};
  const FlowNetwork network = flowNetwork(tree);
  EXPECT_TRUE(assignFlows(patches, network).empty());
  const double flow = 0.2 * std::numbers::pi * 4e-6;
  EXPECT_NEAR(patches[1].flow, flow, 1e-12 * flow);
  EXPECT_NEAR(patches[2].flow, flow * 8 / 9, 1e-9 * flow);
  EXPECT_NEAR(patches[3].flow, flow / 9, 1e-9 * flow);
  EXPECT_TRUE(patches[2].holdsPressure);
  EXPECT_FALSE(patches[3].holdsPressure);
  // Poiseuille: 10 mm of the trunk with all of the flow, 10 mm with 8/9 of it
  const double perLength = 8 * 4e-3 / (std::numbers::pi * 16e-12);
  EXPECT_NEAR(patches[1].drop, perLength * 0.01 * flow * (1 + 8.0 / 9), 1e-6 * patches[1].drop);
  EXPECT_NEAR(patches[2].drop, 0, 1e-9 * patches[1].drop);
}

TEST(FoamPatches, AnInletWithoutAnOutletIsWallAndReported) {
  formats::CenterlineTree tree;
  addBranch(tree, "a", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "b", -1, {9, 0, 0}, {0, 0, 1}, 21, 2);
  std::vector<FoamPatch> patches = {
      patch("inlet-a", FaceKind::Inlet, 2), patch("outlet-a", FaceKind::Outlet, 2),
      patch("inlet-b", FaceKind::Inlet, 2), patch("cap-b", FaceKind::Wall, 2)};
  const FlowNetwork network = flowNetwork(tree);
  const std::vector<std::string> losses = assignFlows(patches, network);
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_EQ(losses[0].find("inlet-b: "), 0U);
  EXPECT_EQ(patches[2].kind, FaceKind::Wall);
  patches.resize(1);
  EXPECT_THROW(assignFlows(patches, network), Error);
}

TEST(FoamPatches, TheWallIsDividedByTheLevelsOfItsRadii) {
  SurfaceMesh mesh;
  mesh.groups = {{"wall", FaceKind::Wall}, {"inlet", FaceKind::Inlet}};
  mesh.radius = {4, 4, 4, 0.1F, 0.1F, 0.1F};
  mesh.position.resize(6);
  mesh.triangle = {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}};
  mesh.group = {0, 0, 1};
  const FoamCells cells = foamCells(withTwigs(1).tree, FoamGrain::Coarse);
  const std::vector<int> levels = divideWall(mesh, cells, 1);
  ASSERT_EQ(mesh.groups.size(), 3U);
  EXPECT_EQ(mesh.groups[2].name, "wall-2");
  EXPECT_EQ(mesh.group, (std::vector<std::uint32_t>{0, 2, 1}));
  EXPECT_EQ(levels[0], cells.level(4));
  EXPECT_EQ(levels[1], cells.level(4));
  EXPECT_EQ(levels[2], cells.level(0.1F));
}

TEST(Waveform, HasAMeanOfOneAndTheSystoleOfTheCommonCarotidArtery) {
  double sum = 0, most = 0;
  constexpr int kTimes = 1000;
  for (int k = 0; k < kTimes; ++k) {
    const double flow = carotidFlow(kCycle * k / kTimes);
    sum += flow / kTimes;
    most = std::max(most, flow);
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_NEAR(carotidFlow(0), carotidFlow(kCycle), 1e-9);
  EXPECT_GT(most, 1.8);
  EXPECT_LT(most, 2.2);
}

}  // namespace lumen::convert
