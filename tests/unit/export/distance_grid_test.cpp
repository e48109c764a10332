// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/distance_grid.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "../surface/closed_cases.h"
#include "converters/base/error.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;

TEST(DistanceGrid, OfAllIsNegativeInEachOfTwoVesselsThatOverlap) {
  // the narrow vessel reaches 0.1 mm into the wide one
  const formats::Case source = kissingCase(-0.1);
  const VesselDistance vessels(source);
  const WallDistance inWide = askAll(vessels, {10, 0, 0}), inNarrow = askAll(vessels, {10, 1.5, 0});
  EXPECT_NEAR(inWide.distance, -1, 0.05);
  EXPECT_EQ(inWide.branch, 0U);
  EXPECT_NEAR(inNarrow.distance, -0.6, 0.05);
  EXPECT_EQ(inNarrow.branch, 1U);
  // where they overlap there is no wall
  EXPECT_LT(askAll(vessels, {10, 0.95, 0}).distance, 0);
}

TEST(DistanceGrid, OfABranchKnowsNothingOfOneThatTouches) {
  const formats::Case source = kissingCase(-0.1);
  const VesselDistance vessels(source);
  const TreeRegion wide = regionOfBranch(source.tree, 0), narrow = regionOfBranch(source.tree, 1);
  EXPECT_EQ(wide.size(), 20U);
  EXPECT_EQ(narrow.size(), 12U);
  // on each axis the other's distance is that to its wall: 1.5 - 1 and 1.5 - 0.6
  EXPECT_NEAR(askBranch(vessels, wide, {10, 1.5, 0}).distance, 0.5, 0.05);
  EXPECT_NEAR(askBranch(vessels, narrow, {10, 0, 0}).distance, 0.9, 0.05);
}

TEST(DistanceGrid, RegionGoesFourRadiiAlongTheTree) {
  // a trunk of 20 nodes 1 mm apart; the side begins on node 10, which its first node is 1.5 mm from, and has 0.8 mm
  const TreeRegion side = regionOfBranch(forkCase().tree, 1);
  TreeRegion expected;
  for (std::uint32_t n = 9; n <= 11; ++n) expected.push_back(n);  // 3.2 - 1.5 - 1 mm are left
  for (std::uint32_t n = 20; n < 28; ++n) expected.push_back(n);
  EXPECT_EQ(side, expected);
}

TEST(DistanceGrid, OfABranchFollowsTheTreeAcrossItsFork) {
  const formats::Case source = forkCase();
  const VesselDistance vessels(source);
  const TreeRegion side = regionOfBranch(source.tree, 1);
  EXPECT_LT(askBranch(vessels, side, {10, 0, 0}).distance, -0.5);  // in the trunk, below the fork
  EXPECT_LT(askBranch(vessels, side, {10, 6, 0}).distance, -0.5);
  EXPECT_GT(askBranch(vessels, side, {10, 6, 2}).distance, 0.5);
}

/// A sample's wall is right; between samples a distance d bends by its second derivatives, whose sum is 1/rho at rho from
/// the axis of a tube: a line between samples h apart is off by at most h^2/8 of it. Near walls of 0.6 mm that is h^2/8/0.5;
/// the one-evaluation distance bends up to twice as much as the nearest one.
TEST(DistanceGrid, ErrsBetweenSamplesAsLinearInterpolationDoes) {
  const formats::Case source = kissingCase(1.0);
  const VesselDistance vessels(source);
  Progress silent;
  for (const double h : {0.4, 0.2, 0.1}) {
    const DistanceGrid grid = sampleGrid({vessels}, latticeOver(kissingBox(), 0, h), silent);
    double worst = 0;
    for (int k = 0; k < 2000; ++k) {
      const double angle = 2 * std::numbers::pi * k / 360, rho = 1 + 0.1 * std::sin(k);
      const Eigen::Vector3d p{4 + 0.006 * k, rho * std::cos(angle), rho * std::sin(angle)};
      const double truth = static_cast<double>(askAll(vessels, p).distance);
      worst = std::max(worst, std::abs(trilinear(grid, p) - truth));
    }
    EXPECT_LT(worst, 2 * h * h / 8 / 0.5) << h;
    EXPECT_GT(worst, 0) << h;
  }
}

TEST(DistanceGrid, OneGridMergesWhatTouchesAndOneForEachBranchDoesNot) {
  const formats::Case source = kissingCase(0.02);
  const VesselDistance vessels(source);
  Progress silent;
  const Lattice lattice = latticeOver(kissingBox(), 0, 0.15);
  const DistanceGrid merged = sampleGrid({vessels}, lattice, silent);
  const TreeRegion wide = regionOfBranch(source.tree, 0);
  const DistanceGrid own = sampleGrid({vessels, &wide}, lattice, silent);
  // along a line from one axis to the other a wall of 0.02 mm is between samples of 0.15 mm
  double mergedMost = -1, ownAtOther = trilinear(own, {10, 1.62, 0});
  for (double y = 0; y <= 1.62; y += 0.01)
    mergedMost = std::max(mergedMost, trilinear(merged, {10, y, 0}));
  EXPECT_LT(mergedMost, 0.05);
  EXPECT_NEAR(ownAtOther, 0.62, 0.05);
}

/// A tube of radius 1 at y = 0 and one of 0.5 at y = 12, along x.
formats::Case wideAndNarrow() {
  formats::Case source;
  source.metadata.voxelSize = 0.2;
  addVessel(source, "wide", straightPath({0, 0, 0}, {1, 0, 0}, 20), 1.0, 1.0);
  addVessel(source, "narrow", straightPath({0, 12, 0}, {1, 0, 0}, 20), 0.5, 1.0);
  addModels(source);
  return source;
}

TEST(DistanceGrid, IsTheDistanceToTheWallFarFromItToo) {
  const formats::Case source = wideAndNarrow();
  const VesselDistance vessels(source);
  for (double y = 1.5; y < 11; y += 0.1)
    for (double x = 3; x < 16; x += 0.7)
      // where both are far, the node of less power answers: at most the difference of the radii
      // decides between them
      ASSERT_NEAR(askAll(vessels, {x, y, 0}).distance, std::min(y - 1, 11.5 - y), 0.5) << y;
}

// Where both are far, the node of least power may be that of the farther wall.
TEST(DistanceGrid, IsTheDistanceToTheNearestOfTwoFarWalls) {
  const formats::Case source = wideAndNarrow();
  const VesselDistance vessels(source);
  Progress silent;
  const DistanceGrid grid =
      sampleGrid({vessels}, latticeOver({{-1, -1, -2}, {20, 13, 2}}, 0, 0.2), silent);
  std::size_t at = 0, far = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid.lattice.size[2]); ++k)
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid.lattice.size[1]); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(grid.lattice.size[0]); ++i, ++at) {
        const Eigen::Vector3d p = grid.lattice.at(i, j, k);
        const double found = static_cast<double>(grid.values[at].distance);
        const double wide = std::hypot(p.y(), p.z()) - 1,
                     narrow = std::hypot(p.y() - 12, p.z()) - 0.5;
        if (p.x() < 4 || p.x() > 15 || std::min(wide, narrow) < 3) continue;
        ++far;
        // walls of models ripple between nodes, by a few hundredths of a radius
        ASSERT_NEAR(found, std::min(wide, narrow), 0.05) << p.transpose();
        if (std::abs(wide - narrow) > 0.1) {
          ASSERT_EQ(grid.values[at].branch, wide < narrow ? 0U : 1U) << p.transpose();
        }
        const double searched = static_cast<double>(askAll(vessels, p).distance);
        ASSERT_LE(found, searched + 1e-3) << p.transpose();
        if (wide < narrow - 1) {
          ASSERT_NEAR(found, searched, 1e-3) << p.transpose();
        }
      }
  EXPECT_GT(far, 10000U);
}

TEST(DistanceGrid, ClampsToItsBand) {
  const formats::Case source = kissingCase(0.5);
  const VesselDistance vessels(source);
  Progress silent;
  const Lattice lattice = latticeOver(kissingBox(), 0, 0.25);
  const DistanceGrid whole = sampleGrid({vessels}, lattice, silent),
                     banded = sampleGrid({vessels, nullptr, 0.3}, lattice, silent);
  ASSERT_EQ(whole.values.size(), lattice.count());
  for (std::size_t i = 0; i < whole.values.size(); ++i)
    ASSERT_EQ(banded.values[i].distance, std::clamp(whole.values[i].distance, -0.3F, 0.3F)) << i;
}

TEST(DistanceGrid, IsTheSameOnAnyNumberOfThreads) {
  const formats::Case source = kissingCase(0.0);
  const VesselDistance vessels(source);
  Progress silent;
  const Lattice lattice = latticeOver(kissingBox(), 0, 0.25);
  const auto bits = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<float> values;
    for (const WallDistance& value : sampleGrid({vessels}, lattice, silent).values)
      values.push_back(value.distance);
    return values;
  };
  EXPECT_EQ(bits(1), bits(4));
}

TEST(DistanceGrid, PartHasTheSamplesOfTheWhole) {
  const Lattice whole = latticeOver(kissingBox(), 0.5, 0.25);
  const Lattice part = cropLattice(whole, {{3, 1, -0.5}, {16, 2, 0.5}}, 0.3);
  for (int a = 0; a < 3; ++a) {
    const double steps = (part.first[a] - whole.first[a]) / 0.25;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
  EXPECT_LE(part.first[1], 0.7);
  EXPECT_GE(part.last()[0], 16.3);
  EXPECT_LT(part.count(), whole.count());
}

TEST(DistanceGrid, RefusesMoreSamplesThanItMayHold) {
  const formats::Case source = kissingCase(0.0);
  const VesselDistance vessels(source);
  Progress silent;
  try {
    sampleGrid({vessels}, latticeOver(kissingBox(), 0, 0.001), silent);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_NE(std::string(error.what()).find("grid 0.001"), std::string::npos) << error.what();
  }
}

}  // namespace lumen::test
