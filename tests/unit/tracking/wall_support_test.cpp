// SPDX-License-Identifier: Apache-2.0
// Walls that the volume supports, and those that it does not.
#include "converters/tracking/wall_support.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "converters/tracking/node_fit.h"
#include "seeded_tubes.h"

namespace lumen::convert {
namespace {

/// A node around `centre` along z, with those points of the wall of the straight tube of `radius`
/// that its circle passes near by.
TrackedNode circleNode(const Vector3d& centre, double nodeRadius, double radius) {
  TrackedNode node;
  node.centre = centre;
  node.radius = nodeRadius;
  node.height = radius;
  for (int i = 0; i < 360; ++i) {
    const double angle = std::numbers::pi * i / 180;
    const Vector3d wall(6.4 + radius * std::cos(angle), 6.4 + radius * std::sin(angle), centre.z());
    if (std::abs((wall - centre).norm() - nodeRadius) < 0.1 * nodeRadius)
      node.points.push_back({static_cast<float>(wall.x()), static_cast<float>(wall.y()),
                             static_cast<float>(wall.z())});
  }
  return node;
}

TEST(WallSupport, ACircleAroundTheLumenHoldsNothingElse) {
  const Volume tube = straightTube(1.2);
  const BsplineVolume volume(tube);
  const TrackedNode node = circleNode({6.4, 6.4, 6.4}, 1.2, 1.2);
  const WallSupport support = wallSupport(volume, node, node.centre, false);
  EXPECT_EQ(support.dark, 0);
  EXPECT_TRUE(isSupported(support));
}

// Its circle touches the lumen's wall from inside on one side, and takes in the dark on the other.
TEST(WallSupport, ACircleHalfInTheDarkIsSeenAndTellsWhereTheLumenIs) {
  const Volume tube = straightTube(1.2);
  const BsplineVolume volume(tube);
  const TrackedNode node = circleNode({7.6, 6.4, 6.4}, 2.4, 1.2);
  ASSERT_GE(node.points.size(), 8u);
  const WallSupport support = wallSupport(volume, node, node.centre, false);
  EXPECT_GT(support.dark, 0.6);
  EXPECT_FALSE(isSupported(support));
  EXPECT_LT((support.middle - Vector3d(6.4, 6.4, support.middle.z())).norm(), 0.4);
  EXPECT_NEAR(support.radius, 1.2, 0.25);
}

/// Two tubes of radius 1.2 beside each other along z, with a gap of `gap` between them; the second
/// is less bright.
Volume companions(double gap) {
  const double aside = 1.2 + 0.5 * gap;
  const auto tube = [](double x) {
    return drawVolume(64, 0.2, [=](const Vector3d& p) {
      return capsule(p, {x, 6.4, 0.4}, {x, 6.4, 12.2}, 1.2);
    });
  };
  Volume both = tube(6.4 - aside);
  const Volume second = tube(6.4 + aside);
  auto& voxels = std::get<std::vector<std::int16_t>>(both.voxels);
  const auto& others = std::get<std::vector<std::int16_t>>(second.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i)
    voxels[i] = static_cast<std::int16_t>(voxels[i] + 0.6 * others[i]);
  return both;
}

TEST(WallSupport, NoNodeIsFittedAroundTwoVesselsAndTheirGap) {
  const Volume volume = companions(1.0);
  const TrackOptions options;
  const Progress silent;
  const BsplineVolume spline(volume);
  const TrackContext context(spline, options, 0, silent);
  TrackWorkspace workspace(context);
  for (const double x : {6.0, 6.4, 6.8})
    for (const double radius : {1.5, 2.0, 2.5, 3.0}) {
      Random random(3);
      const NodeFit fit =
          fitNode(context, {{x, 6.4, 6.4}, Vector3d::UnitZ(), radius}, 0.35, random, workspace);
      if (fit.node) {
        EXPECT_NEAR(fit.node->radius, 1.2, 0.1) << x << " " << radius;
      }
    }
}

TEST(WallSupport, AVesselBesideItsCompanionKeepsItsOwnWall) {
  for (const double click : {-0.6, 0.6}) {
    const double aside = 1.2 + 0.25;
    // half a radius off the axis, towards the other vessel
    const Vector3d at(6.4 + (click < 0 ? -aside + 0.6 : aside - 0.6), 6.4, 6.4);
    const TrackResult tracked = trackOne(companions(0.5), {seedAt("vessel", at)});
    ASSERT_GT(tracked.result.tree.nodeCount(), 8u) << click;
    for (std::size_t i = 0; i < tracked.result.tree.nodeCount(); ++i) {
      if (tracked.result.tree.centre[i].z < 1.5F || tracked.result.tree.centre[i].z > 11.0F)
        continue;
      EXPECT_NEAR(tracked.result.tree.radius[i], 1.2, 0.12);
      EXPECT_NEAR(tracked.result.tree.centre[i].x, 6.4 + (click < 0 ? -aside : aside), 0.15);
    }
  }
}

/// A tube along z whose section is an ellipse of these half axes.
Volume ellipticTube(double a, double b) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) {
    const double x = p.x() - 6.4, y = p.y() - 6.4;
    // the distance to first order: the ellipse's equation over its slope
    const double f = std::sqrt(x * x / (a * a) + y * y / (b * b));
    const double slope = std::hypot(x / (a * a), y / (b * b)) / std::max(f, 1e-6);
    return (f - 1) / std::max(slope, 1e-6);
  });
}

// A circle lies along the sides of such a vessel only, at a radius between its half axes.
TEST(WallSection, AnOblongVesselHasWallPointsAllTheWayAround) {
  constexpr double kA = 1.0, kB = 1.9;
  const TrackResult tracked = trackOne(ellipticTube(kA, kB), {seedAt("oblong", {6.4, 6.4, 6.4})});
  const formats::Case& result = tracked.result;
  ASSERT_GT(result.tree.nodeCount(), 8u);
  std::size_t judged = 0, whole = 0;
  for (std::size_t n = 0; n < result.tree.nodeCount(); ++n) {
    if (std::abs(result.tree.centre[n].z - 6.4F) > 4) continue;
    std::set<int> sectors;
    for (auto i = result.points->offset[n]; i < result.points->offset[n + 1]; ++i) {
      const formats::Vec3f& p = result.points->position[i];
      const double x = p.x - 6.4, y = p.y - 6.4;
      sectors.insert(static_cast<int>((std::atan2(y / kB, x / kA) + std::numbers::pi) * 1.9));
      EXPECT_NEAR(std::hypot(x / kA, y / kB), 1, 0.15);
    }
    ++judged;
    if (sectors.size() >= 11) ++whole;
    EXPECT_NEAR(result.tree.radius[n], std::sqrt(kA * kB), 0.1);
    EXPECT_NEAR(result.tree.centre[n].y, 6.4, 0.25);
  }
  EXPECT_GT(judged, 5u);
  EXPECT_GE(whole, judged * 3 / 4);
}

}  // namespace
}  // namespace lumen::convert
