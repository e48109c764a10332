// SPDX-License-Identifier: Apache-2.0
// Nearest points, first hits of segments, and capsules.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

blob_nearest_point nearest(const Model& model, const Point& p) {
  std::uint32_t cursor = BLOB_NOWHERE;
  blob_nearest_point result;
  blob_nearest(model.get(), 0, p.data(), &cursor, 0, 0, &result);
  return result;
}

TEST(BlobNearest, LiesOnTheWallAndTheWayThereIsTheNormal) {
  const Model model = helix(120, 0.01).build();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(2, 14), off(-0.7, 0.7);
  for (int n = 0; n < 500; ++n) {
    const double a = angle(random);
    const Point p{4 * std::cos(a) + off(random), 4 * std::sin(a) + off(random),
                  5 * a / 6.283185307179586 + off(random)};
    const blob_nearest_point found = nearest(model, p);
    ASSERT_EQ(found.converged, 1) << n;
    std::uint32_t node = found.node;
    blob_sample at;
    blob_query(model.get(), 0, found.point, &node, &at);
    ASSERT_NEAR(at.distance, 0, 2e-5);
    const double offset[3] = {p[0] - found.point[0], p[1] - found.point[1], p[2] - found.point[2]};
    if (std::abs(found.distance) < 0.05) continue;
    double along = 0;
    for (int i = 0; i < 3; ++i) along += offset[i] * at.normal[i] / found.distance;
    ASSERT_NEAR(along, 1.0, 2e-3) << found.distance;
  }
}

// Against the nearest of many points of the wall, which can only be farther than the truth.
TEST(BlobNearest, NoOtherPointOfTheWallIsNearer) {
  const Model model = fork(0.7, 0).build();
  std::vector<Point> wall;
  for (double x = -5; x < 5; x += 0.1)
    for (double a = 0; a < 6.28; a += 0.1) {
      const blob_nearest_point w = nearest(model, {x, std::cos(a), std::sin(a)});
      if (w.converged == 1) wall.push_back({w.point[0], w.point[1], w.point[2]});
    }
  ASSERT_GT(wall.size(), 3000U);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-0.6, 0.6), along(-4, 3);
  for (int n = 0; n < 200; ++n) {
    const Point p{along(random), u(random), u(random)};
    double least = 1e9;
    for (const Point& w : wall)
      least = std::min(least, std::hypot(w[0] - p[0], w[1] - p[1], w[2] - p[2]));
    ASSERT_LT(std::abs(nearest(model, p).distance), least + 0.02)
        << p[0] << " " << p[1] << " " << p[2];
  }
}

// A tolerance a thousand times as small takes checks that the usual one leaves out. Where both end
// at one point, their distances agree. After few steps, the line from the point is the normal so
// closely that the distance could decrease by the promised error only in a valley five times as
// flat as a plane's; longer searches are in places where the models of nodes disagree, and end
// where rounding stops them.
TEST(BlobNearest, TheUsualToleranceIsKept) {
  constexpr std::uint32_t kEasy = 7;
  for (const Tree& tree : {helix(120, 0.01), fork(0.7, 0.02), bend(0.03), kissing(0.1)}) {
    const Model model = tree.build();
    std::mt19937 random(6);
    std::uniform_real_distribution<double> u(-1.5, 1.5);
    int compared = 0;
    for (int n = 0; n < 4000; ++n) {
      const std::size_t node = random() % tree.centre.size();
      const double radius = tree.radius[node];
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = tree.centre[node][k] + radius * u(random);
      auto cursor = static_cast<std::uint32_t>(node);
      blob_nearest_point usual, strict;
      blob_nearest(model.get(), 0, p.data(), &cursor, 0, 0, &usual);
      blob_nearest(model.get(), 0, p.data(), &cursor, 1e-8 * radius, 200, &strict);
      if (usual.converged != 1) continue;
      blob_hessian there;
      std::uint32_t foot = usual.node;
      blob_query_hessian(model.get(), BLOB_HOLD, usual.point, &foot, &there);
      double along = 0, square = 0, apart = 0;
      for (int k = 0; k < 3; ++k) {
        const double way = p[static_cast<std::size_t>(k)] - usual.point[k];
        along += way * there.gradient[k] / norm(there.gradient);
        square += way * way;
        apart += std::abs(usual.point[k] - strict.point[k]);
      }
      if (usual.steps <= kEasy) {
        ASSERT_LT((square - along * along) / (0.4 * std::sqrt(square)), 1e-5 * radius) << n;
      }
      if (strict.converged != 1 || apart > 0.01 * radius) continue;
      ++compared;
      ASSERT_NEAR(usual.distance, strict.distance, 1e-5 * radius) << n;
    }
    EXPECT_GT(compared, 3400);
  }
}

// Between two blobs grad f points along the axis, which leads to no wall. The tube's wall is wavy
// by 0.7 % of its radius.
TEST(BlobNearest, APointOnAnAxisIsTheRadiusFromTheWall) {
  constexpr double kRadius = 4;
  constexpr int kNodes = 30;
  for (const Point& along : {Point{1, 0, 0}, Point{0, 0, -1}, Point{0.6, 0.64, 0.48}}) {
    const auto at = [&along](double mm) {
      return Point{mm * along[0] - 3, mm * along[1] + 5, mm * along[2] + 1};
    };
    Tree tree;
    addVessel(tree, straight(at(0), at(0.6 * kRadius * (kNodes - 1)), kNodes), kRadius, -1, 0);
    const Model model = tree.build();
    for (double mm = 3 * kRadius; mm < 14 * kRadius; mm += 0.0513) {
      const blob_nearest_point found = nearest(model, at(mm));
      ASSERT_EQ(found.converged, 1) << mm;
      ASSERT_NEAR(found.distance, -kRadius, 0.007 * kRadius) << mm;
      std::uint32_t cursor = BLOB_NOWHERE;
      blob_sample exact;
      blob_query(model.get(), BLOB_DISTANCE_EXACT, at(mm).data(), &cursor, &exact);
      ASSERT_EQ(exact.distance, found.distance) << mm;
      double turned = 0;  // of the normal into the axis
      for (std::size_t i = 0; i < 3; ++i) turned += exact.normal[i] * along[i];
      ASSERT_LT(std::abs(turned), 0.1) << mm;
    }
  }
}

TEST(BlobNearest, TheBoundOnStepsIsKeptAndFlagged) {
  const Model model = tube(20).build();
  std::uint32_t cursor = BLOB_NOWHERE;
  blob_nearest_point result;
  const Point p{5, 0.01, 0};
  blob_nearest(model.get(), 0, p.data(), &cursor, 1e-9, 2, &result);
  EXPECT_EQ(result.converged, 0);
  EXPECT_LE(result.steps, 4U);
}

blob_hit shoot(const Model& model, const Point& from, const Point& to, std::uint32_t cursor) {
  blob_hit hit;
  blob_segment_hit(model.get(), 0, from.data(), to.data(), &cursor, 0, 0, &hit);
  return hit;
}

TEST(BlobSegment, ARadialShotHitsAtTheRadius) {
  const blob_hit hit = shoot(tube(20).build(), {6, 0, 0}, {6, 3, 0}, 10);
  EXPECT_EQ(hit.hit, 1);
  EXPECT_NEAR(hit.point[1], 1.0, 4e-3);
  EXPECT_GT(hit.normal[1], 0.99);
}

TEST(BlobSegment, WithinTheLumenNothingIsHit) {
  const blob_hit hit = shoot(tube(20).build(), {2, 0.9, 0}, {9, -0.9, 0.2}, 3);
  EXPECT_EQ(hit.hit, 0);
  EXPECT_EQ(hit.complete, 1);
  EXPECT_EQ(hit.t, 1.0);
}

TEST(BlobSegment, FromOutsideTheNearWallIsHit) {
  const blob_hit hit = shoot(tube(20).build(), {6, 50, 0}, {6, -50, 0}, BLOB_NOWHERE);
  EXPECT_EQ(hit.hit, 1);
  EXPECT_NEAR(hit.point[1], 1.0, 4e-3);
}

// Out of one vessel and into the other through a wall of no thickness.
TEST(BlobSegment, DoesNotTunnelBetweenVesselsThatTouch) {
  for (const double gap : {0.0, 1e-4, 0.01, 0.1}) {
    const Model model = kissing(gap).build();
    for (double x = 3; x < 14; x += 0.173) {
      const blob_hit hit = shoot(model, {x, 0, 0}, {x + 0.5, 2 + gap, 0}, 8);
      ASSERT_EQ(hit.hit, 1) << gap << " " << x;
      ASSERT_NEAR(hit.point[1], 1.0, 0.01);
      ASSERT_LT(hit.node, 30U);
    }
  }
}

// The chord of a helix leaves the vessel and meets it again on the other side.
TEST(BlobSegment, AChordOfABendIsAHit) {
  const Model model = helix(120, 0).build();
  for (int i = 5; i < 80; ++i) {
    const double a = 0.14 * i, b = a + 1.6;
    const double rise = 5 / 6.283185307179586;
    const Point from{4 * std::cos(a), 4 * std::sin(a), rise * a},
        to{4 * std::cos(b), 4 * std::sin(b), rise * b};
    const blob_hit hit = shoot(model, from, to, static_cast<std::uint32_t>(i));
    ASSERT_EQ(hit.hit, 1) << i;
    ASSERT_LT(hit.t, 0.5);
  }
}

// The hit is where a fine scan along the segment first finds the outside.
TEST(BlobSegment, FindsTheFirstCrossing) {
  const Model model = fork(0.6, 0.03).build();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-0.6, 0.6), far(-4, 4);
  for (int n = 0; n < 100; ++n) {
    const Point from{-3 + u(random), u(random), u(random)},
        to{far(random), far(random), far(random)};
    const blob_hit hit = shoot(model, from, to, 3);
    std::uint32_t cursor = 3;
    double first = 2;
    for (int i = 0; i <= 20000 && first > 1; ++i) {
      const double t = i / 20000.0;
      const Point p{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]),
                    from[2] + t * (to[2] - from[2])};
      if (blob_inside(model.get(), 0, p.data(), &cursor) == 0) first = t;
    }
    ASSERT_EQ(hit.hit == 1, first <= 1) << n;
    if (hit.hit == 1) {
      ASSERT_NEAR(hit.t, first, 1e-3);
    }
  }
}

TEST(BlobSegment, TheBoundOnStepsIsKeptAndFlagged) {
  const Model model = tube(20).build();
  std::uint32_t cursor = 0;
  blob_hit hit;
  const Point from{0, 0, 0}, to{11, 0, 0};
  blob_segment_hit(model.get(), 0, from.data(), to.data(), &cursor, 0, 6, &hit);
  EXPECT_EQ(hit.hit, 0);
  EXPECT_EQ(hit.complete, 0);
  EXPECT_GT(hit.t, 0.0);
  EXPECT_LT(hit.t, 1.0);
}

TEST(BlobSegment, ASegmentOfNoLengthHitsNothing) {
  const blob_hit hit = shoot(tube(20).build(), {6, 0, 0}, {6, 0, 0}, 10);
  EXPECT_EQ(hit.hit, 0);
  EXPECT_EQ(hit.complete, 1);
}

// From the axis to 0.5 below the wall: the end is deepest, with 0.2 of the capsule out of 0.5 left.
TEST(BlobCapsule, TheDeepestPointOfASlantedAxisIsItsEnd) {
  const Model model = tube(30).build();
  std::uint32_t cursor = 10;
  blob_approach a;
  const Point from{6, 0, 0}, to{8, 0.7, 0};
  blob_capsule_approach(model.get(), 0, from.data(), to.data(), 0.5, &cursor, &a);
  EXPECT_NEAR(a.t, 1.0, 1e-3);
  EXPECT_NEAR(a.distance, -0.3, 0.03);
  EXPECT_NEAR(a.depth, 0.2, 0.03);
  EXPECT_GT(a.normal[1], 0.99);
}

// A capsule across a bend touches in the middle of the chord, not at its ends.
TEST(BlobCapsule, AcrossABendTheDeepestPointIsBetweenTheEnds) {
  const Model model = helix(120, 0).build();
  const double a = 5.6, b = 6.6, rise = 5 / 6.283185307179586;
  const Point from{4 * std::cos(a), 4 * std::sin(a), rise * a},
      to{4 * std::cos(b), 4 * std::sin(b), rise * b};
  std::uint32_t cursor = 40;
  blob_approach approach;
  blob_capsule_approach(model.get(), 0, from.data(), to.data(), 0.1, &cursor, &approach);
  EXPECT_NEAR(approach.t, 0.5, 0.1);
}

}  // namespace
}  // namespace lumen::blob::test
