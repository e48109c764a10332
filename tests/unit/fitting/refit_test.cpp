// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/stages/fitting/fit.h"
#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "shapes.h"

namespace lumen::convert {
namespace {

using formats::Case;
using Nodes = std::vector<std::uint32_t>;

Case fittedShape(const std::string& name) {
  test::TrackingOptions tracking;
  tracking.noise = 0.05;
  Case value = test::trackShape(name, 1, tracking).value;
  Progress silent;
  fit(value, {}, silent);
  return value;
}

Nodes allNodes(const Case& value) {
  Nodes nodes(value.tree.nodeCount());
  std::iota(nodes.begin(), nodes.end(), 0U);
  return nodes;
}

/// Nodes in the middle of the first branch.
Nodes someNodes(const Case& value) {
  const std::uint32_t middle = value.tree.branches[0].nodeCount / 2;
  return {middle, middle + 1, middle + 2, middle + 3};
}

void refitSome(Case& value, const Nodes& nodes) {
  Progress silent;
  refit(value, nodes, recordedFitOptions(value), silent);
}

TEST(Refit, OfAllNodesIsTheFit) {
  Case value = fittedShape("tube");
  const Case before = value;
  value.models->width.assign(value.models->width.size(), 1);
  refitSome(value, allNodes(value));
  EXPECT_EQ(value, before);
}

TEST(Refit, LeavesTheModelsOfAllOtherNodesBitForBit) {
  Case value = fittedShape("bifurcation");
  const Case before = value;
  Nodes due = someNodes(value);
  // models that are lost: what a new node has
  for (const std::uint32_t node : due)
    for (std::uint32_t k = value.models->offset[node]; k < value.models->offset[node + 1]; ++k)
      value.models->width[k] = 1e-3F;
  const Case damaged = value;
  refitSome(value, due);
  for (std::uint32_t node = 0; node < value.tree.nodeCount(); ++node) {
    const bool isDue = std::find(due.begin(), due.end(), node) != due.end();
    EXPECT_EQ(test::blobsOf(value, node) == test::blobsOf(damaged, node), !isDue) << node;
  }
  EXPECT_EQ(value.tree, before.tree);
  EXPECT_EQ(value.points, before.points);
  EXPECT_EQ(value.metadata, before.metadata);
}

TEST(Refit, GivesTheWallThatTheWholeFitGave) {
  Case value = fittedShape("tube");
  const Case before = value;
  const Nodes due = someNodes(value);
  refitSome(value, due);
  const auto was = formats::caseField(before), is = formats::caseField(value);
  const auto& points = *value.points;
  for (const std::uint32_t node : due)
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k) {
      const auto& p = points.position[k];
      const field::Vec place{double{p.x}, double{p.y}, double{p.z}};
      const auto a = was.blended<1>(place, node), b = is.blended<1>(place, node);
      const double slope = std::hypot(a.gradient[0], a.gradient[1], a.gradient[2]);
      // a tenth of a voxel of 0.2 mm
      EXPECT_LT(std::abs(a.value - b.value) / slope, 0.02);
    }
}

TEST(Refit, ThreadsMakeNoDifference) {
  const Case fitted = fittedShape("bifurcation");
  Case one = fitted, many = fitted;
  {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    refitSome(one, someNodes(one));
  }
  refitSome(many, someNodes(many));
  EXPECT_EQ(one, many);
}

TEST(Refit, KeepsTheTreeReachable) {
  Case value = fittedShape("bifurcation");
  refitSome(value, someNodes(value));
  const auto reach = formats::measureReachability(value.tree, formats::caseField(value));
  EXPECT_EQ(reach.reachable, reach.total);
}

TEST(Refit, LeavesACaseAsItWasWhenCancelled) {
  Case value = fittedShape("tube");
  const Case before = value;
  Progress progress;
  progress.cancel();
  EXPECT_THROW(refit(value, someNodes(value), recordedFitOptions(value), progress), Error);
  EXPECT_EQ(value, before);
}

TEST(Refit, RefusesNodesAndCasesThatAreNone) {
  Case value = fittedShape("tube");
  EXPECT_THROW(refitSome(value, {static_cast<std::uint32_t>(value.tree.nodeCount())}), Error);
  value.models.reset();
  EXPECT_THROW(refitSome(value, {0}), Error);
}

TEST(RecordedFitOptions, AreThoseOfTheFit) {
  test::TrackingOptions tracking;
  Case value = test::trackShape("tube", 1, tracking).value;
  FitOptions options;
  options.kernel = formats::Kernel::Gaussian;
  options.neighbourhood = 3;
  options.seamSweeps = 1;
  options.curvatureWeight = 2e-3;
  options.accuracy = 0.25;
  Progress silent;
  fit(value, options, silent);
  const double voxel = value.metadata.voxelSize.value_or(0);
  EXPECT_EQ(recordedFitOptions(value).resolved(voxel).parameters(),
            options.resolved(voxel).parameters());
}

TEST(RecordedFitOptions, AreTheUsualOnesWhereACaseSaysNonsense) {
  Case value = fittedShape("tube");
  value.metadata.steps.back().parameters = {{"neighbourhood", std::string("many")},
                                            {"cohesion-scale", -3.0},
                                            {"seam-sweeps", std::int64_t{1} << 40}};
  const double voxel = value.metadata.voxelSize.value_or(0);
  EXPECT_EQ(recordedFitOptions(value).resolved(voxel).parameters(),
            FitOptions{}.resolved(voxel).parameters());
}

TEST(StaleNodes, AreNoneWhereNothingChanged) {
  const Case value = fittedShape("bifurcation");
  EXPECT_TRUE(staleNodes(value, value, allNodes(value)).empty());
}

TEST(StaleNodes, AreThoseWithinTwoEdgesOfAWallPointThatMoved) {
  const Case before = fittedShape("tube");
  Case after = before;
  after.points->position[after.points->offset[10]].x += 0.01F;
  EXPECT_EQ(staleNodes(before, after, allNodes(before)), (Nodes{8, 9, 10, 11, 12}));
}

}  // namespace
}  // namespace lumen::convert
