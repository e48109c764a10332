// SPDX-License-Identifier: Apache-2.0
// Steps along a wall whose shape is known: a sphere about the origin, f = R - |X|.
#include "libblob/src/wall_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

#include "libblob/src/wall_foot.h"

namespace lumen::blob {
namespace {

using field::Vec;

constexpr double kRadius = 2;
constexpr StepBounds kBounds{10, 1e-9};

Vec pointAt(double latitude) {
  return {kRadius * std::cos(latitude), 0, kRadius * std::sin(latitude)};
}

/// The wall at a foot on the sphere, seen from a query point.
WallShape sphereAt(const Vec& foot, const Vec& query) {
  const Vec n = (1 / kRadius) * foot;
  WallShape wall{query - foot, n, dot(query - foot, n), 1, {}};
  const double hessian[6] = {n.x * n.x - 1, n.y * n.y - 1, n.z * n.z - 1,
                             n.x * n.y,     n.x * n.z,     n.y * n.z};
  std::transform(hessian, hessian + 6, wall.hessian, [](double h) { return h / kRadius; });
  return wall;
}

// The same sphere as eight searches see it, in floats.
namespace lanes {
// clang-format off
#include "libblob/src/simd/f8_scalar.h"
#include "libblob/src/simd/numbers.h"
#include "libblob/src/simd/foot_lanes.h"
// clang-format on

V8 all(const Vec& v) {
  return {set1(static_cast<float>(v.x)), set1(static_cast<float>(v.y)),
          set1(static_cast<float>(v.z))};
}
Vec first(const V8& v) {
  return {v.x.v[0], v.y.v[0], v.z.v[0]};
}
M8 always() {
  return less(set1(0), set1(1));
}

Shape8 shapeAt(const Vec& foot) {
  const WallShape wall = sphereAt(foot, foot);
  F8 s[6];
  for (int i = 0; i < 6; ++i) s[i] = set1(static_cast<float>(-wall.hessian[i]));
  return {s[0], s[1], s[2], s[3], s[4], s[5]};
}

// A search at a place whose foot is foot.
Searches searchAt(const Vec& foot, const Vec& query, double off) {
  Searches s{};
  const Vec n = (1 / kRadius) * foot;
  const Shape8 shape = shapeAt(foot);
  s.setVector(Searches::Place, 0, all(foot + off * n));
  s.setVector(Searches::Query, 0, all(query));
  const F8 shapes[6] = {shape.xx, shape.yy, shape.zz, shape.xy, shape.xz, shape.yz};
  // seen from a parallel wall, whose radius is that much greater
  const auto wider = static_cast<float>(kRadius / (kRadius + off));
  for (std::size_t i = 0; i < 6; ++i) s.set(Searches::Shape + i, 0, set1(wider) * shapes[i]);
  s.set(Searches::Radius, 0, set1(10));
  s.set(Searches::State, 0, set1(Searches::kFresh));
  s.set(Searches::Share, 0, set1(1));
  s.set(Searches::Reached, 0, set1(kNotReached));
  const V8 normal = all(n);
  store(s.wall[0], set1(static_cast<float>(off)));
  store(s.wall[1], normal.x);
  store(s.wall[2], normal.y);
  store(s.wall[3], normal.z);
  store(s.value, set1(1));
  return s;
}

StepBits step(Searches& s) {
  return stepLanes(s, 0, less(set1(1), set1(0)), {1e-6F, 16});
}

constexpr double kRounding = 1e-6;
}  // namespace lanes

TEST(WallStep, SolvesForTheNearestPointOfASphereToSecondOrder) {
  for (const double share : {0.6, 1.5})  // a query point in the sphere, and one outside
    for (const double away : {0.2, 0.1})
      for (const double off : {0.0, 0.3, -0.3}) {
        const Vec query = share * pointAt(away), foot = pointAt(0);
        lanes::Searches s = lanes::searchAt(foot, query, off);
        EXPECT_EQ(lanes::step(s).found, 0U);
        const Vec there = lanes::first(s.vector(lanes::Searches::Place, 0));
        EXPECT_LT(norm(there - pointAt(away)), kRadius * away * away * away);
        if (off != 0) continue;
        const Vec along = stepDownhill(sphereAt(foot, query), kBounds);
        EXPECT_NEAR(norm(along - lanes::first(s.vector(lanes::Searches::Step, 0))), 0,
                    lanes::kRounding);
      }
}

TEST(WallStep, EndsAtTheNearestPointAndNotBesideIt) {
  lanes::Searches at = lanes::searchAt(pointAt(0.3), 1.5 * pointAt(0.3), 1e-3);
  EXPECT_EQ(lanes::step(at).found, 0xFFU);
  EXPECT_NEAR(norm(lanes::first(at.vector(lanes::Searches::Foot, 0)) - pointAt(0.3)), 0,
              lanes::kRounding);
  lanes::Searches beside = lanes::searchAt(pointAt(0.31), 1.5 * pointAt(0.3), 1e-3);
  EXPECT_EQ(lanes::step(beside).found, 0U);
}

TEST(WallStep, GoesToTheWallFirstWhereItIsFarFromThere) {
  lanes::Searches s = lanes::searchAt(pointAt(0), 1.5 * pointAt(0.3), 1.2);
  lanes::step(s);
  EXPECT_NEAR(norm(lanes::first(s.vector(lanes::Searches::Place, 0)) - pointAt(0)), 0,
              lanes::kRounding);
}

TEST(WallStep, IsNoLongerThanHalfTheRadius) {
  const Vec query = 1.5 * pointAt(1.2);
  EXPECT_NEAR(norm(stepDownhill(sphereAt(pointAt(0), query), {0.1, 1e-9})), 0.05, 1e-12);
  lanes::Searches s = lanes::searchAt(pointAt(0), query, 0);
  s.set(lanes::Searches::Radius, 0, lanes::set1(0.1F));
  lanes::step(s);
  EXPECT_NEAR(s.row[lanes::Searches::Length][0], 0.05, lanes::kRounding);
}

TEST(WallStep, LeavesAFarthestPoint) {
  // from beyond the centre the foot is the farthest point
  const Vec query = -0.5 * pointAt(0);
  EXPECT_GT(norm(stepDownhill(sphereAt(pointAt(0), query), kBounds)), 0.01);
  lanes::Searches s = lanes::searchAt(pointAt(0), query, 0);
  EXPECT_EQ(lanes::step(s).found, 0U);
  EXPECT_GT(s.row[lanes::Searches::Length][0], 0.01);
}

TEST(WallStep, IsShortenedWhereTheWallIsFartherAndThenStuck) {
  lanes::Searches s = lanes::searchAt(pointAt(0), 1.5 * pointAt(0.3), 0);
  lanes::step(s);
  const float length = s.row[lanes::Searches::Length][0];
  const lanes::M8 isLonger = lanes::always();
  EXPECT_EQ(lanes::stepLanes(s, 0, isLonger, {1e-6F, 16}).stuck, 0U);
  const Vec there = lanes::first(s.vector(lanes::Searches::Place, 0));
  EXPECT_NEAR(there.z, lanes::kShorten * length, 1e-3);
  EXPECT_EQ(lanes::stepLanes(s, 0, isLonger, {1e-6F, 16}).stuck, 0U);
  EXPECT_EQ(lanes::stepLanes(s, 0, isLonger, {1e-6F, 16}).stuck, 0xFFU);
}

TEST(BendWall, ExplainsTheTurnOfTheNormalAlongTheMove) {
  lanes::Shape8 shape = lanes::shapeAt(pointAt(0));
  const Vec move = pointAt(0.2) - pointAt(0), turn = (1 / kRadius) * move;
  for (lanes::F8* s : {&shape.xx, &shape.yy, &shape.zz, &shape.xy, &shape.xz, &shape.yz})
    *s = lanes::set1(0.5F) * *s;  // a wall that is taken to be too flat
  bend(shape, lanes::always(), lanes::all(move), lanes::all(turn));
  EXPECT_NEAR(norm(lanes::first(shape * lanes::all(move)) - turn), 0, lanes::kRounding);
}

TEST(BendWall, LeavesAShapeThatExplainsItAndAWallWithoutAMove) {
  lanes::Shape8 shape = lanes::shapeAt(pointAt(0));
  const Vec move{0, 0.1, 0.3}, across{0.3, 0.5, -0.2};  // the move is along the tangent plane
  const Vec before = lanes::first(shape * lanes::all(across));
  bend(shape, lanes::always(), lanes::all(move), lanes::all((1 / kRadius) * move));
  EXPECT_NEAR(norm(lanes::first(shape * lanes::all(across)) - before), 0, lanes::kRounding);
  bend(shape, lanes::always(), lanes::all({0, 0, 0}), lanes::all({0, 0, 0}));
  EXPECT_NEAR(norm(lanes::first(shape * lanes::all(across)) - before), 0, lanes::kRounding);
}

TEST(BendWall, IsTheLeastChangeAcrossTheMoveToo) {
  lanes::Shape8 shape = lanes::shapeAt(pointAt(0));
  const Vec before = lanes::first(shape * lanes::all({0, 1, 0}));
  bend(shape, lanes::always(), lanes::all({0, 0, 0.1}), lanes::all({0, 0, 0.1}));
  const Vec across = lanes::first(shape * lanes::all({0, 1, 0}));
  EXPECT_NEAR(norm(across - before), 0, lanes::kRounding);
}

}  // namespace
}  // namespace lumen::blob
