// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/posing.h"

#include <cmath>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lumen::convert
