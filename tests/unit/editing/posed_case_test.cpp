// SPDX-License-Identifier: Apache-2.0
// A fitted tube along x, bent and widened over time, as it stands at one time.
#include "converters/stages/editing/posed_case.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
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

}  // namespace
}  // namespace lumen::convert
