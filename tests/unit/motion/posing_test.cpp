// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/posing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/motion/search.h"
#include "converters/stages/motion/track_motion.h"
#include "trees.h"

namespace lumen::convert {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(MotionPosing, CarriesCentresDirectionsRadiiAndWallPoints) {
  formats::Case rest;
  rest.tree = test::forkedTree();
  rest.points = formats::PointSets{};
  rest.points->offset.assign(1, 0);
  for (std::uint32_t i = 0; i < rest.tree.nodeCount(); ++i) {
    rest.points->position.push_back(toVec3f(toEigen(rest.tree.centre[i]) + Vector3d(0, 0, 1)));
    rest.points->offset.push_back(i + 1);
  }
  const Quaterniond turn(AngleAxisd(0.5 * M_PI, Vector3d::UnitX()));  // z goes to -y
  std::vector<formats::Pose> poses;
  for (const auto& centre : rest.tree.centre)
    poses.push_back(poseOf(toEigen(centre) + Vector3d(1, 2, 3), turn, 2));
  const formats::Case posed = posedWalls(rest, poses);
  EXPECT_TRUE((toEigen(posed.tree.centre[3]) - toEigen(rest.tree.centre[3]))
                  .isApprox(Vector3d(1, 2, 3), 1e-6));
  EXPECT_TRUE(toEigen(posed.tree.direction[3]).isApprox(Vector3d(0, -1, 0), 1e-6));
  EXPECT_FLOAT_EQ(posed.tree.radius[3], 2);
  EXPECT_FLOAT_EQ(posed.tree.height[3], 1);
  EXPECT_TRUE((toEigen(posed.points->position[3]) - toEigen(posed.tree.centre[3]))
                  .isApprox(Vector3d(0, -2, 0), 1e-5));
}

TEST(MotionPosing, TurnsNodesByWhatTheirCentresShow) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Quaterniond turn(AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()));
  std::vector<Vector3d> centres;
  for (const auto& centre : tree.centre) centres.push_back(turn * toEigen(centre));
  const auto poses = posesFromCentres(tree, centres, std::vector<double>(tree.nodeCount(), 1.0));
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    // all but a turn about the vessel itself
    const Vector3d along = toEigen(tree.direction[i]);
    if (i == 21 || i == 32) continue;  // first of an arm: its direction at rest is from the trunk
    EXPECT_TRUE((rotationOf(poses[i]) * along).isApprox(turn * along, 1e-5)) << i;
  }
}

TEST(MotionPosing, ATreeThatRestsHasNoTurn) {
  const formats::CenterlineTree tree = test::forkedTree();
  std::vector<Vector3d> centres;
  for (const auto& centre : tree.centre) centres.push_back(toEigen(centre));
  for (const formats::Pose& pose :
       posesFromCentres(tree, centres, std::vector<double>(tree.nodeCount(), 1.0)))
    EXPECT_NEAR(pose.rotation[3], 1, 1e-6);
}

bool isStation(const Stations& s, std::uint32_t node) {
  return std::find(s.node.begin(), s.node.end(), node) != s.node.end();
}

TEST(MotionStations, AreRootsTipsForksAndNodesARadiusApart) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Stations s = placeStations(tree);
  for (const std::uint32_t node : {0U, 12U, 16U, 20U, 31U, 42U})
    EXPECT_TRUE(isStation(s, node)) << node;
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_LT(s.parent[i], static_cast<std::int32_t>(i));
    EXPECT_LE(s.gap[i], 2.0 + 1e-6) << i;  // two radii and less than two nodes
  }
  EXPECT_EQ(std::count(s.parent.begin(), s.parent.end(), -1), 1);
  EXPECT_LT(s.size(), tree.nodeCount());
  const auto tip = std::find(s.node.begin(), s.node.end(), 20U) - s.node.begin();
  EXPECT_GE(s.gap[static_cast<std::size_t>(tip)], 1.0);
}

TEST(MotionStations, StandForTheWholeLength) {
  const Stations s = placeStations(test::forkedTree());
  // 20 edges of the trunk, 11 of each arm with the one to its parent
  const double first = std::hypot(0.5, 0.0), second = std::hypot(0.5, 0.0);
  EXPECT_NEAR(std::accumulate(s.length.begin(), s.length.end(), 0.0),
              10.0 + 5.0 + first + 5.0 + second, 1e-5);
}

TEST(MotionStations, SpreadsMovesLinearlyAlongTheTree) {
  const formats::CenterlineTree tree = test::forkedTree();
  const Stations s = placeStations(tree);
  // a linear move along z comes back on the trunk; a constant one everywhere
  std::vector<Eigen::Vector3d> moves;
  for (const std::uint32_t node : s.node)
    moves.emplace_back(0.1 * double{tree.centre[node].z}, 2, 0);
  const std::vector<Eigen::Vector3d> all = s.spread(moves);
  ASSERT_EQ(all.size(), tree.nodeCount());
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    EXPECT_NEAR(all[i].x(), 0.1 * double{tree.centre[i].z}, 1e-6) << i;
    EXPECT_NEAR(all[i].y(), 2, 1e-12);
  }
}

TEST(MotionStations, KnowWhereTheTreeEnds) {
  const Stations s = placeStations(test::forkedTree());
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::uint32_t node = s.node[i];
    EXPECT_EQ(s.end[i], node == 0 ? -1 : node == 20 || node == 31 || node == 42 ? 1 : 0) << node;
  }
}

TEST(MotionStations, ABranchOfOneNodeIsAStation) {
  formats::CenterlineTree tree = test::forkedTree();
  test::addBranch(tree, 5, {0, 0, 2.5}, {0.3, 0, 0}, 1, 0.3F);
  const Stations s = placeStations(tree);
  EXPECT_TRUE(isStation(s, 43));
  EXPECT_TRUE(isStation(s, 5));
}

using Eigen::Vector3d;

std::vector<MeasuredMove> unmeasured(const formats::CenterlineTree& tree) {
  std::vector<MeasuredMove> result;
  for (const auto& direction : tree.direction)
    result.push_back({Vector3d::Zero(), toEigen(direction), 0});
  return result;
}

TEST(MotionSmoothing, NothingMeasuredMovesNothing) {
  const formats::CenterlineTree tree = test::forkedTree();
  for (const Vector3d& move : smoothMoves(tree, unmeasured(tree), 0.01)) EXPECT_EQ(move.norm(), 0);
}

TEST(MotionSmoothing, OneMeasurementMovesTheTreeAcrossIt) {
  const formats::CenterlineTree tree = test::forkedTree();
  auto measured = unmeasured(tree);
  measured[10].move = {0.5, 0.2, 9};  // the part along the vessel is not known
  measured[10].deviation = 0.01;
  const auto moves = smoothMoves(tree, measured, 0.01);
  for (const Vector3d& move : moves) EXPECT_TRUE(move.isApprox(Vector3d(0.5, 0.2, 0), 1e-2));
}

TEST(MotionSmoothing, TwoMeasurementsAreJoinedByALine) {
  const formats::CenterlineTree tree = test::forkedTree();
  auto measured = unmeasured(tree);
  measured[0].deviation = measured[12].deviation = 1e-3;
  measured[12].move = {1.2, 0, 0};
  const auto moves = smoothMoves(tree, measured, 1.0);
  for (int i = 0; i <= 12; ++i) EXPECT_NEAR(moves[static_cast<std::size_t>(i)].x(), 0.1 * i, 1e-3);
  EXPECT_NEAR(moves[31].x(), 1.2, 1e-3);  // the arm goes along
}

TEST(MotionSmoothing, OneThatIsFarOffCountsLittle) {
  const formats::CenterlineTree tree = test::forkedTree();
  auto measured = unmeasured(tree);
  for (std::size_t i = 0; i <= 20; ++i) {
    measured[i].move = {0.3, 0, 0};
    measured[i].deviation = 0.05;
  }
  measured[10].move = {6, 0, 0};
  for (std::size_t i = 0; i <= 20; ++i)
    EXPECT_NEAR(smoothMoves(tree, measured, 0.01)[i].x(), 0.3, 0.02);
}

TEST(MotionSmoothing, NumbersAreMeansOfTheirNeighbours) {
  const formats::CenterlineTree tree = test::forkedTree();
  std::vector<MeasuredNumber> measured(tree.nodeCount());
  Random random(7, 1);
  double mean = 0;
  for (auto& m : measured) {
    m = {0.1 + 0.02 * (2 * random.uniform() - 1), 0.02};
    mean += m.value / static_cast<double>(measured.size());
  }
  const auto smooth =
      smoothNumbers(tree, measured, std::vector<double>(tree.nodeCount(), 1e-6), 0.2);
  for (const double number : smooth) EXPECT_NEAR(number, mean, 2e-3);
}

}  // namespace
}  // namespace lumen::convert
