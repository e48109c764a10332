// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/open_edges.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/stages/fitting/fit.h"
#include "formats/case/blobby.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "shapes.h"
#include "tests/unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// Two rows of eleven beads of radius 1 along x, half a radius apart, and a gap of 2.4 mm from x = 5
/// between them: 0.4 mm of it is closed.
Case closedTube(float y = 0) {
  Case value = formats::test::noBeads();
  auto places = alongX(0, 0.5F, 11, y);
  for (const auto& place : alongX(7.4F, 0.5F, 11, y)) places.push_back(place);
  addBeads(value, "a", places, 1);
  return value;
}

double missing(const Case& value) {
  const auto found = formats::measureReachability(value.tree, formats::caseField(value));
  return found.total - found.reachable;
}

/// The blobs of a node.
TEST(OpenEdges, OpensAnEdgeThatIsClosed) {
  Case value = closedTube();
  ASSERT_GT(missing(value), 5);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, LeavesOpenTreesAsTheyAre) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  const Case before = value;
  openEdges(value);
  EXPECT_EQ(value, before);
}

TEST(OpenEdges, AddsToTheNodesOfTheEdgeAndChangesNothingElse) {
  const Case before = closedTube();
  Case value = before;
  openEdges(value);
  EXPECT_EQ(value.tree, before.tree);
  for (std::uint32_t node = 0; node < before.tree.nodeCount(); ++node) {
    auto blobs = test::blobsOf(value, node);
    if (node == 10 || node == 11) {
      ASSERT_GE(blobs.size(), 2U);
      blobs.resize(1);
    }
    EXPECT_EQ(blobs, test::blobsOf(before, node)) << node;
  }
}

TEST(OpenEdges, StaysWithinTheTube) {
  Case value = closedTube();
  openEdges(value);
  const field::BlendedField field = formats::caseField(value);
  for (double x = 5; x <= 7.4; x += 0.05)
    for (int i = 0; i < 16; ++i) {
      const double angle = 0.3926991 * i;
      const field::Vec wall{x, 1.02 * std::cos(angle), 1.02 * std::sin(angle)};
      EXPECT_LT(field.blended(wall, field.follow(wall, x < 6.2 ? 10 : 11)).value, field.level())
          << x;
    }
}

TEST(OpenEdges, MakesNoBulgeOfAThinVessel) {
  // of radius 0.2 and T = 0.1 mm, closed by a gap of a tenth of the radius
  Case value = formats::test::noBeads();
  auto places = alongX(0, 0.1F, 11);
  for (const auto& place : alongX(1.42F, 0.1F, 11)) places.push_back(place);
  addBeads(value, "a", places, 0.2F);
  ASSERT_GT(missing(value), 1);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
  const field::BlendedField field = formats::caseField(value);
  for (double x = 1; x <= 1.42; x += 0.02) {
    const field::Vec wall{x, 0.21, 0};
    EXPECT_LT(field.blended(wall, field.follow(wall, x < 1.21 ? 10 : 11)).value, field.level())
        << x;
  }
}

TEST(OpenEdges, OpensAVesselThatBeginsAlongAnotherOneHoweverLongTheStretchIs) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 81), 1);
  std::vector<formats::Vec3f> places = alongX(0.5F, 0.4F, 70, 0.4F);
  for (std::size_t k = 0; k < places.size(); ++k) places[k].y += 0.025F * static_cast<float>(k);
  addBeads(value, "b", places, 0.5F, 0);
  ASSERT_GT(missing(value), 5);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, OpensARootsOwnCentre) {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 5), 1);
  value.models->centre[0].y = 1.1F;
  ASSERT_EQ(missing(value), 2);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
}

TEST(OpenEdges, KeepsVesselsThatTouchApart) {
  Case value = closedTube();
  const std::uint32_t other = addBeads(value, "b", alongX(0, 0.5F, 40, 2), 1);
  openEdges(value);
  EXPECT_EQ(missing(value), 0);
  const field::BlendedField field = formats::caseField(value);
  // across the place where they touch, beside the opening, from either side
  for (const bool upwards : {true, false}) {
    std::uint32_t cursor = upwards ? 10 : other + 12;
    bool left = false;
    for (double y = upwards ? 0 : 2; upwards ? y <= 2 : y >= 0; y += upwards ? 0.05 : -0.05) {
      const field::Vec point{6.2, y, 0};
      cursor = field.follow(point, cursor);
      left = left || field.blended(point, cursor).value <= field.level();
    }
    EXPECT_TRUE(left);
    EXPECT_EQ(cursor < other, upwards);
  }
}

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
