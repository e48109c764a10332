// SPDX-License-Identifier: Apache-2.0
// The tube phantom with models of known radius, and trees that leave something out.
#include "converters/judge/check/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/phantom.h"
#include "straight_models.h"

namespace lumen::convert {
namespace {

Phantom phantomOf(const std::string& name, double noise = 0) {
  PhantomOptions options;
  options.name = name;
  options.size = 64;
  options.noise = noise;
  options.bias = 0;
  Progress progress;
  return makePhantom(options, progress);
}

CheckReport reportOf(const Volume& volume, const formats::Case& value) {
  Progress progress;
  return checkCase(volume, value, {kBlur, false}, progress).report;
}

double tubeRadius(const Phantom& tube) {
  return static_cast<double>(tube.truth.tree.radius[0]);
}

class TubeCheck : public ::testing::TestWithParam<double> {};

// Promise of section 7.1 of docs/method.md: 0.03 voxel, and a twentieth of the offset, as an edge
// that lies far from the wall has fewer samples on its far side.
TEST_P(TubeCheck, OffsetIsHowMuchTheModelIsTooWide) {
  const double error = GetParam() * kVoxel;
  for (const double noise : {0.0, 0.05}) {
    Phantom tube = phantomOf("tube", noise);
    addStraightModels(tube.truth, tubeRadius(tube) + error);
    const CheckReport report = reportOf(tube.volume, tube.truth);
    EXPECT_GT(report.offsets.samples, 1000U);
    EXPECT_NEAR(report.offsets.median, error, 0.03 * kVoxel + 0.05 * std::abs(error));
    // the steepest fall lies a little inside of a round wall
    EXPECT_NEAR(report.offsets.uncorrectedMedian, error, 0.25 * kVoxel);
    EXPECT_NEAR(report.offsets.steepestMedian, error, 0.25 * kVoxel);
    EXPECT_LT(report.offsets.noEdge + report.offsets.wrongPolarity, 0.01);
    EXPECT_NEAR(report.offsets.beyondVoxel, std::abs(error) > kVoxel ? 1 : 0, 0.02);
    EXPECT_TRUE(report.missing.vessels.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Voxels, TubeCheck, ::testing::Values(-1.5, -0.5, 0.0, 0.25, 1.5));

// The spline averages noise between voxels, by a fifth at most, and edges take the brightest and the
// darkest voxel beside them.
TEST(Check, ContrastIsComparedWithTheNoiseBeyondTheWall) {
  const auto ratioAt = [](double noise) {
    Phantom tube = phantomOf("tube", noise);
    addStraightModels(tube.truth, tubeRadius(tube));
    return reportOf(tube.volume, tube.truth).offsets.contrastToNoise;
  };
  const double ratio = ratioAt(0.05);
  EXPECT_GT(ratio, 20);
  EXPECT_LT(ratio, 20 * 1.4);
  EXPECT_NEAR(ratioAt(0.025) / ratio, 2, 0.2);
  EXPECT_GT(ratioAt(0), 10 * ratio);
}

TEST(Check, LumenHasTheVolumeOfItsModel) {
  Phantom tube = phantomOf("tube");
  addStraightModels(tube.truth, tubeRadius(tube));
  const CheckReport report = reportOf(tube.volume, tube.truth);
  const auto& centre = tube.truth.tree.centre;
  const double length = (toEigen(centre.back()) - toEigen(centre.front())).norm();
  const double exact = std::numbers::pi * tubeRadius(tube) * tubeRadius(tube) * length;
  EXPECT_NEAR(report.lumenVolume, exact, 0.03 * exact);
  EXPECT_EQ(report.dark.volume, 0);
}

// A model twice as wide holds three times the vessel's volume of darkness, less a voxel at its wall.
TEST(Check, DarkLumenIsFoundInAModelThatIsTooWide) {
  Phantom tube = phantomOf("tube");
  const double radius = tubeRadius(tube), inner = 2 * radius - kVoxel;
  for (float& r : tube.truth.tree.radius) r *= 2;
  addStraightModels(tube.truth, 2 * radius);
  const CheckReport report = reportOf(tube.volume, tube.truth);
  const double exact = (inner * inner - radius * radius) / (4 * radius * radius);
  EXPECT_NEAR(report.dark.volume / report.lumenVolume, exact, 0.1);
  ASSERT_EQ(report.dark.regions.size(), 1U);
}

TEST(Check, ABranchInTheDarkHasNoEdge) {
  Phantom tube = phantomOf("tube", 0.05);
  formats::CenterlineTree& tree = tube.truth.tree;
  const auto count = static_cast<std::uint32_t>(tree.nodeCount());
  for (std::uint32_t n = 0; n < count; ++n) {
    tree.centre.push_back(tree.centre[n]);
    tree.centre.back().x -= 3;
    tree.direction.push_back(tree.direction[n]);
    tree.radius.push_back(tree.radius[n]);
    tree.height.push_back(tree.height[n]);
    tree.parent.push_back(n == 0 ? formats::kNoParent : static_cast<std::int32_t>(count + n - 1));
    tree.branch.push_back(1);
  }
  tree.branches.push_back(tree.branches[0]);
  tree.branches[1].firstNode = count;
  addStraightModels(tube.truth, tubeRadius(tube));
  const CheckReport report = reportOf(tube.volume, tube.truth);
  EXPECT_LT(report.branches[0].offsets.noEdge, 0.01);
  EXPECT_GT(report.branches[1].offsets.noEdge, 0.95);
  EXPECT_EQ(report.nodes[count + count / 2], Agreement::Poor);
  ASSERT_FALSE(report.dark.regions.empty());
  for (const Region& place : report.dark.regions) EXPECT_GE(place.node, count);
}

/// The fork, with models for its trunk only; the radius serves both ends of it.
struct Fork {
  Phantom phantom = phantomOf("bifurcation", 0.05);
  formats::Case trunk = phantom.truth;
  Fork() {
    auto& tree = trunk.tree;
    const std::uint32_t count = tree.branches[0].nodeCount;
    for (auto* list : {&tree.centre, &tree.direction}) list->resize(count);
    for (auto* list : {&tree.radius, &tree.height}) list->resize(count);
    tree.parent.resize(count);
    tree.branch.resize(count);
    tree.inlierRate.clear();
    tree.branches.resize(1);
    addStraightModels(trunk, static_cast<double>(tree.radius[0]));
  }
};

TEST(Check, AVesselThatTheCaseLeavesOutIsAPlaceWithItsLengthAndRadius) {
  const Fork fork;
  const CheckReport report = reportOf(fork.phantom.volume, fork.trunk);
  ASSERT_EQ(report.missing.vessels.size(), 1U);
  const MissingVessel& vessel = report.missing.vessels[0];
  const auto& tree = fork.phantom.truth.tree;
  const formats::Branch& child = tree.branches[1];
  const auto first = static_cast<std::size_t>(child.firstNode);
  const double whole = (toEigen(tree.centre.back()) - toEigen(tree.centre[first])).norm();
  const auto radius = static_cast<double>(tree.radius[first]);
  const TubeTreeDistance wall(tree, 1);
  for (const VesselPathPoint& point : vessel.path)
    EXPECT_LT(wall.nearest(point.position).distance, 0);
  EXPECT_NEAR(vessel.radius, radius, 0.2 * radius);
  // it begins two voxels outside of the trunk, and its end is round
  EXPECT_NEAR(vessel.length, whole + radius - static_cast<double>(tree.radius[0]), 5 * kVoxel);
  EXPECT_LT(vessel.path.front().node, child.firstNode);
  EXPECT_FALSE(vessel.atEnd);
  EXPECT_TRUE(report.missing.wide.regions.empty());
  const formats::CenterlineTree& trunk = fork.trunk.tree;
  const double modelled = (toEigen(trunk.centre.back()) - toEigen(trunk.centre.front())).norm();
  EXPECT_NEAR(report.shownLength, modelled, 0.02 * modelled);
  EXPECT_EQ(report.missingLength(), vessel.length);
}

TEST(Check, AVesselOfTheCaseIsNoPlace) {
  Phantom tube = phantomOf("tube", 0.08);
  addStraightModels(tube.truth, tubeRadius(tube));
  EXPECT_TRUE(reportOf(tube.volume, tube.truth).missing.vessels.empty());
}

TEST(Check, ABranchOfHalfTheContrastIsMeasuredAsWell) {
  Phantom tube = phantomOf("tube");
  auto& voxels = std::get<std::vector<std::int16_t>>(tube.volume.voxels);
  const std::size_t slice = 64 * 64;
  for (std::size_t i = 0; i < voxels.size(); ++i) {  // falls to a third from one end to the other
    const double fade = 1 - 0.67 * static_cast<double>(i / slice) / 63;
    voxels[i] = static_cast<std::int16_t>(100 + fade * (voxels[i] - 100));
  }
  addStraightModels(tube.truth, tubeRadius(tube));
  const CheckReport report = reportOf(tube.volume, tube.truth);
  EXPECT_NEAR(report.offsets.median, 0, 0.03 * kVoxel);
  EXPECT_LT(report.offsets.noEdge, 0.01);
  EXPECT_EQ(report.dark.volume, 0);
  EXPECT_TRUE(report.missing.vessels.empty());
}

TEST(Check, DarkVesselsAreMeasuredLikeBrightOnes) {
  Phantom tube = phantomOf("tube");
  addStraightModels(tube.truth, tubeRadius(tube) + 0.5 * kVoxel);
  const CheckReport bright = reportOf(tube.volume, tube.truth);
  for (auto& voxel : std::get<std::vector<std::int16_t>>(tube.volume.voxels))
    voxel = static_cast<std::int16_t>(-voxel);
  Progress progress;
  const CheckReport dark = checkCase(tube.volume, tube.truth, {kBlur, true}, progress).report;
  EXPECT_EQ(dark.offsets.samples, bright.offsets.samples);
  EXPECT_NEAR(dark.offsets.median, bright.offsets.median, 1e-6);
  EXPECT_EQ(dark.lumenVolume, bright.lumenVolume);
}

TEST(Check, ThrowsIfNoNodeLiesInTheVolume) {
  Phantom tube = phantomOf("tube");
  addStraightModels(tube.truth, tubeRadius(tube));
  tube.volume.geometry.origin = {1000, 0, 0};
  Progress progress;
  EXPECT_THROW(checkCase(tube.volume, tube.truth, {}, progress), Error);
}

TEST(Check, ThreadsDoNotChangeTheReport) {
  const Fork fork;
  const CheckReport many = reportOf(fork.phantom.volume, fork.trunk);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CheckReport single = reportOf(fork.phantom.volume, fork.trunk);
  EXPECT_EQ(many.offsets.median, single.offsets.median);
  EXPECT_EQ(many.offsets.absoluteP90, single.offsets.absoluteP90);
  EXPECT_EQ(many.nodes, single.nodes);
  EXPECT_EQ(many.missing.vessels[0].length, single.missing.vessels[0].length);
}

TEST(Check, LabelsCountBranchesFromOne) {
  Phantom tube = phantomOf("tube");
  addStraightModels(tube.truth, tubeRadius(tube));
  Progress progress;
  const CheckResult result = checkCase(tube.volume, tube.truth, {}, progress);
  const Volume labels = labelVolume(tube.volume.geometry, tube.truth.tree, result.lumen);
  const auto& values = std::get<std::vector<std::uint8_t>>(labels.voxels);
  EXPECT_EQ(values.size(), tube.volume.geometry.voxelCount());
  EXPECT_EQ(static_cast<std::size_t>(std::count(values.begin(), values.end(), 1)),
            result.lumen.size());
  EXPECT_EQ(*std::max_element(values.begin(), values.end()), 1);
  EXPECT_EQ(labels.geometry.spacing, tube.volume.geometry.spacing);
}

TEST(Overlay, DrawsTheTreeInTheColourOfItsAgreement) {
  Phantom tube = phantomOf("tube");
  const auto greens = [&](double radius) {
    addStraightModels(tube.truth, radius);
    const Picture picture =
        drawOverlay(tube.volume, tube.truth.tree, reportOf(tube.volume, tube.truth));
    // above the legend, where the same colour explains itself
    return std::count_if(picture.pixels.begin(),
                         picture.pixels.begin() + std::ptrdiff_t{200} * picture.width,
                         [](const Rgb& p) { return p[1] > p[0] + 50 && p[1] > p[2] + 50; });
  };
  EXPECT_GT(greens(tubeRadius(tube)), 200);
  EXPECT_EQ(greens(tubeRadius(tube) + 1.5 * kVoxel), 0);
}

TEST(SourceDifference, NamesWhatDiffersFirst) {
  formats::SourceVolume a;
  a.size = {4, 5, 6};
  a.spacing = {1, 1, 2};
  a.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  a.sha256 = "a";
  EXPECT_FALSE(sourceDifference(a, a));
  formats::SourceVolume b = a;
  b.sha256 = "b";
  EXPECT_EQ(sourceDifference(b, a)->what, "voxels");
  b.origin[1] = 0.5;
  EXPECT_EQ(sourceDifference(b, a)->what, "origin");
  EXPECT_EQ(sourceDifference(b, a)->found, "0 0.5 0");
  b.spacing[2] = 1.5;
  EXPECT_EQ(sourceDifference(b, a)->what, "spacing");
  b.size[0] = 3;
  EXPECT_EQ(sourceDifference(b, a)->what, "size");
}

}  // namespace
}  // namespace lumen::convert
