// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/sampled_path.h"

#include <utility>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lumen::convert
