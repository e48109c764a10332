// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/join_curves.h"

#include <array>

#include <gtest/gtest.h>

#include "converters/io/centerline/centerline_readers.h"

namespace lumen::convert {
namespace {

/// Points one apart along x from `from`, of radius 1, that rise by `slope`.
CenterlineCurve straight(const Eigen::Vector3d& from, int count, const Eigen::Vector3d& step,
                         double radius = 1) {
  CenterlineCurve curve;
  for (int i = 0; i < count; ++i) curve.points.push_back({from + i * step, radius});
  return curve;
}

std::size_t rootsOf(const CenterlineFile& file) {
  std::size_t roots = 0;
  for (const CenterlinePoint& point : file.points) roots += point.parent == kNoPoint ? 1 : 0;
  return roots;
}

TEST(JoinCurves, LinesFromARootToItsTipsHaveTheTrunkOnce) {
  CenterlineCurve left = straight({0, 0, 0}, 11, {1, 0, 0}), right = left;
  for (int i = 1; i <= 5; ++i) {
    left.points.push_back({{10.0 + i, 1.0 * i, 0}, 0.8});
    right.points.push_back({{10.0 + i, -1.0 * i, 0}, 0.8});
  }
  const CenterlineFile file = joinCurves({left, right});
  EXPECT_EQ(file.points.size(), 11U + 5 + 5);
  EXPECT_EQ(rootsOf(file), 1U);
  const auto chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[1].parentSample, 10U);
}

TEST(JoinCurves, ATrunkThatIsSampledAnewIsTheSameTrunk) {
  CenterlineCurve left = straight({0, 0, 0}, 21, {1, 0, 0});
  CenterlineCurve right = straight({0.5, 0.05, 0}, 10, {1, 0, 0});
  for (int i = 1; i <= 5; ++i) right.points.push_back({{10.0 + i, -1.0 * i, 0}, 0.8});
  const CenterlineFile file = joinCurves({left, right});
  EXPECT_EQ(file.points.size(), 21U + 5);
  EXPECT_EQ(rootsOf(file), 1U);
}

TEST(JoinCurves, ACurveHangsOnTheOneInWhoseLumenItBegins) {
  const CenterlineFile file =
      joinCurves({straight({5.2, 0.6, 0}, 5, {0, 1, 0}, 0.4), straight({0, 0, 0}, 11, {1, 0, 0}),
                  straight({5, 1.4, 3}, 5, {0, 1, 0}, 0.4)});
  EXPECT_EQ(rootsOf(file), 2U);  // the third begins in none
  const auto chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 3U);
  EXPECT_EQ(chains[0].points.size(), 11U);
  EXPECT_EQ(chains[1].parent, 0);
  EXPECT_EQ(chains[1].parentSample, 5U);
  EXPECT_EQ(chains[1].points.size(), 5U);
}

TEST(JoinCurves, ACurveThatOnlyEndsInAnotherOneIsTurnedRound) {
  CenterlineCurve child = straight({5, 6, 0}, 7, {0, -1, 0}, 0.4);
  const CenterlineFile file = joinCurves({straight({0, 0, 0}, 11, {1, 0, 0}), child});
  EXPECT_EQ(rootsOf(file), 1U);
  EXPECT_EQ(file.points.back().position, Eigen::Vector3d(5, 6, 0));
  EXPECT_TRUE(file.links.empty());
}

TEST(JoinCurves, ACurveBetweenTwoOthersClosesALoop) {
  const CenterlineCurve bottom = straight({0, 0, 0}, 11, {1, 0, 0});
  CenterlineCurve arc;
  for (const auto& [x, y] :
       std::array<std::array<double, 2>, 5>{{{2, 0}, {2, 4}, {5, 6}, {8, 4}, {8, 0}}})
    arc.points.push_back({{x, y, 0}, 0.5});
  const CenterlineFile file = joinCurves({bottom, arc});
  EXPECT_EQ(rootsOf(file), 1U);
  ASSERT_EQ(file.links.size(), 1U);
  EXPECT_EQ(file.points[std::size_t(file.links[0][0])].position, Eigen::Vector3d(8, 0, 0));
  EXPECT_EQ(file.points[std::size_t(file.links[0][1])].position, Eigen::Vector3d(8, 4, 0));
}

TEST(JoinCurves, ACurveThatIsThereTwiceIsThereOnce) {
  const CenterlineCurve curve = straight({0, 0, 0}, 11, {1, 0, 0});
  EXPECT_EQ(joinCurves({curve, curve}).points.size(), 11U);
}

TEST(JoinCurves, WhatAFileSaysGoesBeforeWhatLiesNear) {
  CenterlineCurve child = straight({5, 0, 0}, 4, {0, 1, 0}, 0.4);
  child.parent = 1;
  child.parentPoint = 2;
  const CenterlineFile file =
      joinCurves({straight({0, 0, 0}, 11, {1, 0, 0}), straight({0, 9, 0}, 4, {1, 0, 0}), child});
  EXPECT_EQ(rootsOf(file), 2U);
  const CenterlinePoint& first = file.points[file.points.size() - 4];
  EXPECT_EQ(first.position, Eigen::Vector3d(5, 0, 0));
  EXPECT_EQ(file.points[std::size_t(first.parent)].position, Eigen::Vector3d(2, 9, 0));
}

using Indices = std::vector<std::int32_t>;

TEST(Chains, AtAForkTheWidestChildGoesOn) {
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 2 -1\n2 0 1 0 0 2 1\n3 0 2 0 0 1 2\n4 0 1 1 0 1.5 2\n5 0 1 2 0 1.5 4\n", "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].points, (Indices{0, 1, 3, 4}));
  EXPECT_EQ(chains[1].points, Indices{2});
  EXPECT_EQ(chains[1].parent, 0);
  EXPECT_EQ(chains[1].parentSample, 1U);
}

TEST(Chains, OfEquallyWideChildrenTheOneThatTurnsLeastGoesOn) {
  const CenterlineFile file =
      parseSwc("1 0 0 0 0 2 -1\n2 0 1 0 0 2 1\n3 0 1 1 0 1 2\n4 0 2 0.1 0 1 2\n", "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].points, (Indices{0, 1, 3}));
  EXPECT_EQ(chains[1].points, Indices{2});
}

TEST(Chains, APointAtThePlaceOfItsParentIsOneWithIt) {
  // the root is there three times, and so is the point that the last one hangs on
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 2 -1\n2 0 0 0 0 2 1\n3 0 1 0 0 2 2\n4 0 1 0 0 1 3\n5 0 1 1 0 1 4\n"
      "6 0 2 0 0 2 3\n7 0 0 0 0 1 1\n8 0 -1 0 0 1 7\n",
      "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 3U);
  EXPECT_EQ(chains[0].points, (Indices{0, 2, 5}));
  EXPECT_EQ(chains[1].points, Indices{7});
  EXPECT_EQ(chains[1].parentSample, 0U);
  EXPECT_EQ(chains[2].points, Indices{4});
  EXPECT_EQ(chains[2].parentSample, 1U);
}

TEST(Chains, EveryRootBeginsATreeAndParentsComeFirst) {
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 1 -1\n2 0 9 0 0 1 -1\n3 0 1 0 0 1 1\n4 0 9 1 0 1 2\n5 0 8 0 0 0.5 2\n6 0 7 0 0 "
      "0.5 5\n7 0 8 1 0 0.4 5\n",
      "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 4U);
  EXPECT_EQ(chains[0].parent, -1);
  EXPECT_EQ(chains[1].parent, -1);
  for (std::size_t c = 0; c < chains.size(); ++c)
    EXPECT_LT(chains[c].parent, static_cast<std::int32_t>(c));
  EXPECT_EQ(chains[3].points, Indices{6});
  EXPECT_EQ(chains[3].parent, 2);
}

TEST(Chains, ALoneRootIsAChainOfOnePoint) {
  const std::vector<CenterlineChain> chains = centerlineChains(parseSwc("1 0 0 0 0 1 -1\n", "t"));
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_EQ(chains[0].points, Indices{0});
}

}  // namespace
}  // namespace lumen::convert
