// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/sampled_path.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/judge/compare/compare.h"
#include "formats/case/blobby.h"
#include "lines.h"

namespace lumen::convert {
namespace {

std::vector<PathSample> pathOf(const std::vector<double>& xs, double y) {
  std::vector<PathSample> path;
  for (const double x : xs) path.push_back({{x, y, 0}, 1, false});
  return path;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

TEST(SampledPath, IsEvenAndKeepsBothEnds) {
  const formats::Case truth = straightTruth();
  const SampledPath path = samplePath(truth.tree, 0, 0.3, false);
  EXPECT_EQ(path.samples.size(), 68U);  // 20 / 0.3 rounds up to 67 steps
  EXPECT_NEAR(path.spacing, 20.0 / 67, 1e-12);
  EXPECT_NEAR(path.samples[10].position.x(), 200.0 / 67, 1e-6);
  EXPECT_EQ(path.samples.back().position.x(), 20);
}

TEST(SampledPath, BeginsWithTheLinkToTheParentNode) {
  formats::Case value = straightTruth();
  addLine(value, "b01", {10, 2, 0}, {10, 8, 0}, 0.5, 20);
  const SampledPath path = samplePath(value.tree, 1, 0.1, true);
  EXPECT_NEAR(path.samples.front().position.y(), 0, 1e-12);
  EXPECT_TRUE(path.samples[19].onLink);
  EXPECT_FALSE(path.samples[21].onLink);
  EXPECT_NEAR(path.samples[21].radius, 0.5, 1e-6);
  EXPECT_EQ(samplePath(value.tree, 1, 0.1, false).samples.size(), 61U);
}

TEST(SampledPath, ASampleAtTheFirstNodeOfABranchIsNotOnItsLink) {
  formats::Case value = straightTruth();
  addLine(value, "b01", {10, 2, 0}, {10, 8, 0}, 0.5, 20);
  const SampledPath path = samplePath(value.tree, 1, 0.5, true);  // 2 mm of link, 6 mm of branch
  EXPECT_EQ(path.samples[4].position.y(), 2);
  EXPECT_TRUE(path.samples[3].onLink);
  EXPECT_FALSE(path.samples[4].onLink);
}

TEST(ClosestOn, InterpolatesTheRadiusBetweenSamples) {
  std::vector<PathSample> path = pathOf({0, 1, 2}, 0);
  path[2].radius = 3;
  const ClosestPoint closest = closestOn(path, {1.25, 2, 0});
  EXPECT_DOUBLE_EQ(closest.distance, 2);
  EXPECT_DOUBLE_EQ(closest.radius, 1.5);
  EXPECT_EQ(closest.index, 1U);
}

TEST(Correspond, PairsPathsSideBySideStraightAcross) {
  EXPECT_EQ(correspond(pathOf({0, 1, 2}, 0), pathOf({0, 1, 2}, 0.5)),
            (Pairs{{0, 0}, {1, 1}, {2, 2}}));
}

TEST(Correspond, TiesTheRestOfALongerPathToTheEndOfTheShorter) {
  EXPECT_EQ(correspond(pathOf({0, 1, 2, 3}, 0), pathOf({0, 1}, 0)),
            (Pairs{{0, 0}, {1, 1}, {2, 1}, {3, 1}}));
}

TEST(Correspond, KeepsTheOrderAlongBothPaths) {
  // the second path goes back over itself; its detour stays tied to one sample
  const Pairs pairs = correspond(pathOf({0, 1, 2, 3, 4}, 0), pathOf({0, 1, 2, 1, 2, 3, 4}, 0));
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    EXPECT_GE(pairs[i].first, pairs[i - 1].first);
    EXPECT_GE(pairs[i].second, pairs[i - 1].second);
  }
  EXPECT_EQ(pairs.back(), (std::pair<std::uint32_t, std::uint32_t>{4, 6}));
}

TEST(Correspond, OfAnEmptyPathIsEmpty) {
  EXPECT_TRUE(correspond({}, pathOf({0}, 0)).empty());
}

// A straight vessel of radius 1 whose nodes all have the same model: a long row of blobs on the
// axis, with the iso-level chosen so that its surface has a given radius.
// Models of the nodes of `found` whose surface has this radius about the x axis.
void addModels(formats::Case& found, double radius) {
  formats::BlobbyModels models;
  models.offset.push_back(0);
  for (std::size_t n = 0; n < found.tree.nodeCount(); ++n) {
    for (int i = -100; i <= 100; ++i) {
      models.centre.push_back({found.tree.centre[n].x + 0.25F * static_cast<float>(i), 0, 0});
      models.width.push_back(1);
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  const formats::Vec3f& first = found.tree.centre[0];
  models.isoLevel = formats::evaluateField(models, 0, {static_cast<double>(first.x), radius, 0}).f;
  found.models = models;
}

// Points on a ring of radius 1 around every node.
void addPoints(formats::Case& found) {
  formats::PointSets points;
  points.offset.push_back(0);
  for (std::size_t n = 0; n < found.tree.nodeCount(); ++n) {
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.5 * i;
      points.position.push_back({found.tree.centre[n].x, static_cast<float>(std::cos(angle)),
                                 static_cast<float>(std::sin(angle))});
    }
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  found.points = points;
}

TEST(WallDistance, IsAbsentWithoutModels) {
  const Comparison result = compared(straightTruth(), straightTruth());
  EXPECT_FALSE(result.wallDistance);
  EXPECT_FALSE(result.branches[0].wallDistance);
}

TEST(WallDistance, OfASurfaceATenthOfAMillimetreTooWide) {
  formats::Case found = straightTruth();
  addModels(found, 1.1);
  const Comparison result = compared(found, straightTruth());
  ASSERT_TRUE(result.wallDistance);
  EXPECT_NEAR(result.wallDistance->median, 0.1, 0.002);
  EXPECT_NEAR(result.wallDistance->p90, 0.1, 0.002);
  EXPECT_NEAR(result.wallDistance->max, 0.1, 0.002);
  EXPECT_NEAR(result.branches[0].wallDistance->max, 0.1, 0.002);
}

TEST(WallDistance, IsTheSameFromWallPointsAsFromRays) {
  formats::Case found = straightTruth();
  addModels(found, 0.9);
  addPoints(found);
  EXPECT_NEAR(compared(found, straightTruth()).wallDistance->median, 0.1, 0.002);
}

TEST(WallDistance, IgnoresWhatLiesBeyondTheEndsOfTheTruth) {
  // the found vessel runs on as if it were 26 mm long; its surface there is far from the true wall
  formats::Case found;
  addLine(found, "root", {-3, 0, 0}, {23, 0, 0}, 1);
  addModels(found, 1);
  EXPECT_NEAR(compared(found, straightTruth()).wallDistance->max, 0, 0.002);
}

TEST(WallDistance, IgnoresTheNeighbourhoodOfJunctions) {
  // the root's models know nothing of the child, whose opening would be up to 0.5 mm from their
  // surface
  formats::Case truth = straightTruth();
  addLine(truth, "b01", {10, 0, 0}, {10, 10, 0}, 0.5, 20);
  formats::Case found = straightTruth();
  addModels(found, 1);
  const Comparison result = compared(found, truth);
  EXPECT_NEAR(result.wallDistance->max, 0, 0.002);
  EXPECT_FALSE(result.branches[1].wallDistance);
}

TEST(WallDistance, SeesTheWrongRadiusOfOneNodeInItsOwnCellOnly) {
  // one node of 39 has blobs that are half as wide again; its cell is half a millimetre of 18
  formats::Case found = straightTruth();
  addModels(found, 1);
  for (std::uint32_t b = found.models->offset[20]; b < found.models->offset[21]; ++b)
    found.models->width[b] = 1.5F;
  const Quantiles wall = *compared(found, straightTruth()).wallDistance;
  EXPECT_GT(wall.max, 0.3);
  EXPECT_NEAR(wall.p90, 0, 0.002);
}

TEST(WallDistance, StopsWhenCancelled) {
  formats::Case found = straightTruth();
  addModels(found, 1);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(compareCases(found, straightTruth(), progress), Error);
}

}  // namespace
}  // namespace lumen::convert
