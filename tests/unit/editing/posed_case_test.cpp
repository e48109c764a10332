// SPDX-License-Identifier: Apache-2.0
// A fitted tube along x, bent and widened over time, as it stands at one time.
#include "converters/stages/editing/posed_case.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/case_field.h"
#include "formats/case/motion.h"
#include "formats/case/validate.h"
#include "formats/field/posed_field.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using field::NodePose;
using field::Vec;
using formats::Case;
using formats::Vec3f;

Progress quiet;

Vec exact(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

// Eleven nodes a millimetre apart, radius 1 mm, with 24 wall points each.
Case tube() {
  Case value = formats::test::noBeads();
  value.models.reset();
  value.metadata.voxelSize = 0.2;
  formats::test::addBeads(value, "a", formats::test::alongX(0, 1, 11), 1);
  value.points.emplace().offset.push_back(0);
  for (const Vec3f& c : value.tree.centre) {
    for (int k = 0; k < 24; ++k) {
      const auto angle = static_cast<float>(0.2617993878 * k);
      const float along = 0.25F * static_cast<float>(k % 4) - 0.375F;
      value.points->position.push_back({c.x + along, std::cos(angle), std::sin(angle)});
    }
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  fit(value, {}, quiet);
  return value;
}

// The tube from 0 s on, bent to a radius of 40 mm about z at 1 s, and `factor` as wide.
Case bending(float factor) {
  Case value = tube();
  formats::Motion& motion = value.motion.emplace();
  motion.time = {0, 1};
  for (int t = 0; t < 2; ++t)
    for (std::uint32_t i = 0; i < 11; ++i) {
      const double angle = t * (double{value.tree.centre[i].x} / 40);
      formats::Pose pose{value.tree.centre[i], {0, 0, 0, 1}, t == 0 ? 1 : factor};
      if (t > 0)
        pose.centre = {static_cast<float>(40 * std::sin(angle)),
                       static_cast<float>(40 * (1 - std::cos(angle))), 0};
      pose.rotation = {0, 0, static_cast<float>(std::sin(angle / 2)),
                       static_cast<float>(std::cos(angle / 2))};
      if (t == 0) motion.node.push_back(i);
      motion.pose.push_back(pose);
    }
  return value;
}

// Greatest first-order distance of a case's wall points from its surface, mm.
double worstWall(const Case& value) {
  const field::BlendedField blended = formats::caseField(value);
  double worst = 0;
  for (std::uint32_t i = 1; i < 10; ++i)
    for (std::uint32_t k = value.points->offset[i]; k < value.points->offset[i + 1]; ++k) {
      const Vec point = exact(value.points->position[k]);
      const auto f = blended.blended(point, blended.follow(point, i));
      const Vec slope{f.gradient[0], f.gradient[1], f.gradient[2]};
      worst = std::max(worst, std::abs(f.value - blended.level()) / field::norm(slope));
    }
  return worst;
}

// spec: M51
TEST(PosedCase, HasThePosedFieldOfACaseWhoseRadiiStay) {
  const Case value = bending(1);
  const Case posed = posedCase(value, 0.5, quiet);
  ASSERT_TRUE(formats::validate(posed));
  const field::BlendedField rest = formats::caseField(value), at = formats::caseField(posed);
  const field::PosedField moving(rest, formats::treeViewOf(value.tree),
                                 formats::posesAt(value.tree, *value.motion, 0.5));
  for (const Vec3f& p : posed.points->position) {
    const Vec point = exact(p);
    const std::uint32_t node = at.locate(point);
    EXPECT_NEAR(at.blended(point, node).value, moving.blended(point, node).value, 1e-5);
  }
}

TEST(PosedCase, LeavesTheBlobsOfItsFirstTimeAsTheyAre) {
  const Case value = bending(1);
  const Case posed = posedCase(value, 0, quiet);
  EXPECT_EQ(posed.models->centre, value.models->centre);
  EXPECT_EQ(posed.tree, value.tree);
}

TEST(PosedCase, FitsNewBlobsWhereTheRadiusChanges) {
  const Case value = bending(1.25F);
  const Case posed = posedCase(value, 1, quiet);
  EXPECT_FLOAT_EQ(posed.tree.radius[3], 1.25F);
  EXPECT_LT(worstWall(posed), worstWall(value) + 0.01);
}

TEST(PosedCase, RecordsTheTimeAndHasNoMotion) {
  const Case posed = posedCase(bending(1), 0.25, quiet);
  EXPECT_FALSE(posed.motion);
  EXPECT_EQ(posed.metadata.steps.back().name, "pose");
  EXPECT_EQ(std::get<double>(posed.metadata.steps.back().parameters.at("time")), 0.25);
}

TEST(PosedCase, IsRefusedWithoutAMotionOrWallPointsForNewModels) {
  EXPECT_THROW(posedCase(tube(), 0, quiet), Error);
  Case value = bending(1.25F);
  value.points.reset();
  EXPECT_THROW(posedCase(value, 1, quiet), Error);
  EXPECT_NO_THROW(posedCase(value, 0, quiet));
}

// Edits of a case with a motion, on beads along x: "a" with two that hang on it, and one on the second.
using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// "a" has nodes 0 to 10, "b" 11 to 15 on node 10, "c" 16 to 20 on node 4, "d" 21 to 25 on node 18.
Case fourVessels() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  addBeads(value, "b", alongX(5.5F, 0.5F, 5), 1, 10);
  addBeads(value, "c", alongX(2, 0.5F, 5, 0.5F), 1, 4);
  addBeads(value, "d", alongX(3, 0.5F, 5, 1), 1, 18);
  return value;
}

// A motion of nodes 4 and 18, with centres of their own.
formats::Motion swayOf(const Case& value) {
  formats::Motion motion{{0, 1}, 0, {4, 18}, {}};
  for (int t = 0; t < 2; ++t)
    for (const std::uint32_t node : motion.node) {
      formats::Pose pose{value.tree.centre[node], {0, 0, 0, 1}, 1};
      pose.centre.z += static_cast<float>(t) + static_cast<float>(node);
      motion.pose.push_back(pose);
    }
  return motion;
}

// spec: M53
TEST(MotionEdits, KeepTheMotionOfNodesThatStayWhereTheyAre) {
  Case value = fourVessels();
  value.motion = swayOf(value);
  const formats::Motion before = *value.motion;
  const Change change = deleteBranch(value, 1, Hanging::Go);
  ASSERT_TRUE(value.motion);
  EXPECT_TRUE(change.droppedArrays.empty());
  ASSERT_EQ(value.motion->node.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(change.before[value.motion->node[n]], before.node[n]);
    EXPECT_EQ(value.motion->pose[2 + n], before.pose[2 + n]);
  }
  EXPECT_LT(value.motion->node[1], 18U);
}

// spec: M53
TEST(MotionEdits, DropTheMotionWhereNodesAreNewOrMoved) {
  Case joined = fourVessels();
  joined.motion = swayOf(joined);
  ASSERT_TRUE(cutBefore(joined, 7).droppedArrays.empty());
  EXPECT_TRUE(joined.motion);
  EXPECT_EQ(joinBranch(joined, 1, 0).droppedArrays, std::vector<std::string>{"motion"});
  EXPECT_FALSE(joined.motion);
  Case moved = fourVessels();
  moved.motion = swayOf(moved);
  moveNode(moved, 4, {2, 0.25, 0}, 1);
  EXPECT_FALSE(moved.motion);
}

}  // namespace
}  // namespace lumen::convert
