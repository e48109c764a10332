// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/motion/track_motion.h"
#include "trees.h"

namespace lumen::convert {
namespace {

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
