// SPDX-License-Identifier: Apache-2.0
// Walls that the volume supports, and those that it does not.

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/wall_review.h"
#include "tube_volume.h"

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

// A guess beside the vessel, wide enough to see one side of it.
TEST(WallSupport, AGuessBesideAVesselFindsTheVesselOrNothing) {
  const Volume tube = straightTube(0.8);
  const TrackOptions options;
  const Progress silent;
  const BsplineVolume spline(tube);
  const TrackContext context(spline, options, 0, silent);
  int found = 0;
  for (const double aside : {0.6, 0.8, 1.0, 1.2})
    for (const double radius : {1.0, 1.5, 2.0, 2.5}) {
      TrackRun run(context, Random(3));
      const NodeGuess guess{{6.4 + aside, 6.4, 6.4}, Vector3d::UnitZ(), radius};
      const NodeFit fit = fitNode(run, guess, 0.35);
      if (!fit.node) continue;
      ++found;
      EXPECT_NEAR(fit.node->radius, 0.8, 0.05) << aside << " " << radius;
    }
  EXPECT_GT(found, 4);
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
    EXPECT_NEAR(result.tree.radius[n], std::sqrt(kA * kB), 0.15);
    EXPECT_NEAR(result.tree.centre[n].y, 6.4, 0.25);
  }
  EXPECT_GT(judged, 5u);
  EXPECT_GE(whole, judged * 3 / 4);
}

// Within 2 mm the tube narrows to half its radius: a cylinder leans on one flank of that, 15 degrees
// off the axis and a twentieth of a millimetre beside it.
TEST(WallSection, ATaperKeepsItsCentresAndDirectionsOnTheAxis) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    const double part = std::clamp((p.z() - 5.4) / 2.0, 0.0, 1.0);
    return std::hypot(p.x() - 6.4, p.y() - 6.4) - (1.4 - 0.7 * part);
  });
  const TrackResult tracked = trackOne(volume, {seedAt("taper", {6.4, 6.4, 3.0})});
  const formats::CenterlineTree& tree = tracked.result.tree;
  double aside = 0, leaning = 0;
  std::size_t judged = 0;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    if (tree.centre[n].z < 5.4F || tree.centre[n].z > 7.4F) continue;
    ++judged;
    aside += std::hypot(tree.centre[n].x - 6.4, tree.centre[n].y - 6.4);
    leaning += std::acos(std::min(1.0, std::abs(double{tree.direction[n].z})));
  }
  ASSERT_GE(judged, 3u);
  EXPECT_LT(aside / static_cast<double>(judged), 0.03);
  EXPECT_LT(leaning / static_cast<double>(judged), 0.1);
}

/// Nodes as tracked along the straight tube, every 0.4 mm.
std::vector<TrackedNode> nodesAlongTube(double radius) {
  std::vector<TrackedNode> nodes;
  for (double z = 2; z < 11; z += 0.4) {
    TrackedNode node = circleNode({6.4, 6.4, z}, radius, radius);
    node.inlierRate = 0.6;
    nodes.push_back(std::move(node));
  }
  return nodes;
}

TEST(WallReview, SwollenNodesAreFittedAnewAndOthersKept) {
  const Volume tube = straightTube(1.0);
  const BsplineVolume spline(tube);
  const TrackOptions options;
  const Progress silent;
  const TrackContext context(spline, options, 0, silent);
  TrackedTree tree{{seedAt("tube", {6.4, 6.4, 6.4})}, std::vector<TrackedBranch>(1)};
  std::vector<TrackedBranch>& branches = tree.branches;
  branches[0].nodes = nodesAlongTube(1.0);
  const auto before = branches[0].nodes;
  for (const std::size_t n : {10u, 11u}) {
    branches[0].nodes[n].radius = 1.9;
    branches[0].nodes[n].centre.x() += 0.8;
  }
  reviewWalls(context, tree);
  ASSERT_EQ(branches[0].nodes.size(), before.size());
  for (std::size_t n = 0; n < before.size(); ++n) {
    const TrackedNode& node = branches[0].nodes[n];
    EXPECT_EQ(node.origin, formats::NodeOrigin::Measured);
    EXPECT_NEAR(node.radius, 1.0, 0.05) << n;
    EXPECT_LT(std::hypot(node.centre.x() - 6.4, node.centre.y() - 6.4), 0.1) << n;
    if (n != 10 && n != 11) {
      EXPECT_EQ(node.centre, before[n].centre) << n;
    }
  }
}

// In a volume that is empty where the swollen nodes are, nothing fits there.
TEST(WallReview, SwollenNodesWithoutAVesselAreMarkedAsBridged) {
  const Volume gap = drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, 4.6}, 1.0),
                    capsule(p, {6.4, 6.4, 9.0}, kHigh, 1.0));
  });
  const BsplineVolume spline(gap);
  const TrackOptions options;
  const Progress silent;
  const TrackContext context(spline, options, 0, silent);
  TrackedTree tree{{seedAt("tube", {6.4, 6.4, 6.4})}, std::vector<TrackedBranch>(1)};
  std::vector<TrackedBranch>& branches = tree.branches;
  branches[0].nodes = nodesAlongTube(1.0);
  branches[0].nodes[12].radius = 1.9;  // at z = 6.8
  reviewWalls(context, tree);
  const TrackedNode& node = branches[0].nodes[12];
  EXPECT_EQ(node.origin, formats::NodeOrigin::Bridged);
  EXPECT_TRUE(node.points.empty());
  EXPECT_NEAR(node.radius, 1.0, 1e-9);
  EXPECT_LT((node.centre - Vector3d(6.4, 6.4, 6.8)).norm(), 1e-6);
}

}  // namespace
}  // namespace lumen::convert
