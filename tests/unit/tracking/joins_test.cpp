// SPDX-License-Identifier: Apache-2.0
// Starts, ends and joints of tracks (docs/method.md, sections 1.7 and 1.12), on drawn tubes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/joining.h"
#include "converters/stages/tracking/lumen_paths.h"
#include "formats/case/node_origin.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using formats::NodeOrigin;
using formats::StopReason;

using Distance = std::function<double(const Vector3d&)>;

/// The tube around a polyline.
Distance tubeAlong(std::vector<Vector3d> line, double radius) {
  return [line = std::move(line), radius](const Vector3d& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < line.size(); ++i)
      least = std::min(least, capsule(p, line[i - 1], line[i], radius));
    return least;
  };
}

Volume draw(const Distance& distance) {
  return drawVolume(64, 0.2, distance);
}

double distanceToTree(const formats::CenterlineTree& tree, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const formats::Vec3f& centre : tree.centre)
    least = std::min(least, (toEigen(centre) - p).norm());
  return least;
}

/// Every edge of a tree is about as long as its cylinders.
void expectNoLongEdge(const formats::CenterlineTree& tree) {
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] == formats::kNoParent) continue;
    const auto p = static_cast<std::size_t>(tree.parent[i]);
    const double height = double{std::max(tree.height[i], tree.height[p])};
    const double radius = double{std::max(tree.radius[i], tree.radius[p])};
    EXPECT_LT((toEigen(tree.centre[i]) - toEigen(tree.centre[p])).norm(),
              1.3 * std::max(height, radius))
        << "node " << i;
  }
}

/// Two legs along z whose axes are 2.4 radii apart, and the half circle between them.
std::vector<Vector3d> hairpin() {
  std::vector<Vector3d> line{{5.8, 6.4, 0.6}};
  for (int i = 0; i <= 12; ++i) {
    const double a = std::numbers::pi * i / 12;
    line.emplace_back(6.52 - 0.72 * std::cos(a), 6.4, 10.0 + 0.72 * std::sin(a));
  }
  line.emplace_back(7.24, 6.4, 0.6);
  return line;
}

TEST(Joins, AHairpinIsPassed) {
  SeedBranch seed = seedAt("leg", {5.8, 6.4, 2}, 0.6);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(draw(tubeAlong(hairpin(), 0.6)), {seed});
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_LT(distanceToTree(out.result.tree, {7.24, 6.4, 3}), 0.5);
  expectNoLongEdge(out.result.tree);
}

TEST(Joins, ANarrowVesselOpensIntoAWideOne) {
  const Vector3d mouth(6.4, 6.4, 5);
  const Volume volume = draw([&](const Vector3d& p) {
    return std::min(capsule(p, kLow, mouth, 0.5), capsule(p, {6.4, 6.4, 6.2}, kHigh, 1.5));
  });
  SeedBranch seed = seedAt("artery", {6.4, 6.4, 1.5}, 0.5);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(volume, {seed});
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_GT(out.result.tree.centre.back().z, 9.0F);
  EXPECT_NEAR(out.result.tree.radius.back(), 1.5, 0.2);
}

TEST(Joins, AVesselThatCrossesAnotherGoesOnBeyondIt) {
  const Volume cross = draw([](const Vector3d& p) {
    return std::min(capsule(p, kLow, kHigh, 0.8),
                    capsule(p, {0.6, 6.4, 6.4}, {12.2, 6.4, 6.4}, 0.7));
  });
  const TrackResult out = trackOne(
      cross, {seedAt("first", {6.4, 6.4, 2.5}, 0.8), seedAt("second", {10.0, 6.4, 6.4}, 0.7)});
  for (const double z : {2.0, 5.0, 8.0, 11.0})
    EXPECT_LT(distanceToTree(out.result.tree, {6.4, 6.4, z}), 0.6) << z;
  for (const double x : {2.0, 4.0, 9.0, 11.0})
    EXPECT_LT(distanceToTree(out.result.tree, {x, 6.4, 6.4}), 0.6) << x;
}

TEST(Joins, AChildIsLedToTheAxisOfItsParent) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {9.5, 6.5, 6.4}, 0.7);
  child.parent = "trunk";
  const TrackResult out = trackOne(tee(0.7), {trunk, child});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  const auto& tree = out.result.tree;
  const auto first = static_cast<std::size_t>(tree.branches[1].firstNode);
  const auto at = static_cast<std::size_t>(tree.branches[1].parentNode);
  EXPECT_LT((toEigen(tree.centre[first]) - toEigen(tree.centre[at])).norm(), 0.8);
  expectNoLongEdge(tree);
  EXPECT_EQ(formats::readNodeOrigins(out.result)[first], NodeOrigin::Bridged);
  EXPECT_EQ(formats::readNodeOrigins(out.result).back(), NodeOrigin::Measured);
}

TEST(Joins, AGapIsFilledWithBridgedNodes) {
  const Volume volume = draw([](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, 5.0}, 1.0),
                    capsule(p, {6.4, 6.4, 8.2}, kHigh, 1.0));
  });
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 2.5}, 1.0);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(volume, {seed});
  EXPECT_GT(out.result.tree.centre.back().z, 11.0F);
  expectNoLongEdge(out.result.tree);
  const auto origins = formats::readNodeOrigins(out.result);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const bool isInGap = out.result.tree.centre[i].z > 6.4F && out.result.tree.centre[i].z < 6.8F;
    if (isInGap) {
      EXPECT_EQ(origins[i], NodeOrigin::Bridged) << out.result.tree.centre[i].z;
    }
  }
  EXPECT_GT(std::count(origins.begin(), origins.end(), NodeOrigin::Bridged), 0);
}

TEST(Joins, AChildOfAParentWithoutATrackIsTracked) {
  SeedBranch child = seedAt("child", {6.4, 6.4, 6}, 0.6);
  child.parent = "nothing";
  const TrackResult out = trackOne(straightTube(0.6), {seedAt("nothing", {2, 2, 2}, 0.6), child});
  ASSERT_EQ(out.failures.size(), 1u);
  EXPECT_EQ(out.failures[0].label, "nothing");
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_LT(out.result.tree.centre.front().z, 1.5F);
  EXPECT_GT(out.result.tree.centre.back().z, 11.0F);
}

TEST(Joins, AGrandchildHangsOnWhatItsParentShouldHaveHungOn) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch lost = seedAt("lost", {2, 2, 2}, 0.6), child = seedAt("child", {11, 6.4, 6.4}, 0.7);
  lost.parent = "trunk";
  child.parent = "lost";
  const TrackResult out = trackOne(tee(0.7), {trunk, lost, child});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  EXPECT_EQ(out.result.tree.branches[1].label, "child");
  ASSERT_GE(out.result.tree.branches[1].parentNode, 0);
  const auto at = static_cast<std::size_t>(out.result.tree.branches[1].parentNode);
  EXPECT_NEAR(out.result.tree.centre[at].z, 6.4, 1.0);
}

TEST(Joins, ATailIsTheClicksThatNamesIt) {
  // the parent's track runs on into the vessel that the child's click names
  SeedBranch parent = seedAt("parent", {6.4, 6.4, 2}, 0.8);
  parent.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {6.4, 6.45, 7});
  child.parent = "parent";
  const TrackResult out = trackOne(straightTube(0.8), {parent, child});
  EXPECT_TRUE(out.failures.empty());
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  const auto& tree = out.result.tree;
  const auto first = static_cast<std::size_t>(tree.branches[1].firstNode);
  EXPECT_NEAR(tree.centre[first].z, 7, 0.8);
  EXPECT_GT(tree.centre.back().z, 11.0F);
  EXPECT_EQ(static_cast<std::size_t>(tree.parent[first]), first - 1);
  expectNoLongEdge(tree);
}

TEST(Joins, AClickInARoundedEndStartsALittleWayAlong) {
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 0.2}, 1.0);
  const TrackResult out = trackOne(draw([](const Vector3d& p) {
                                     return capsule(p, {6.4, 6.4, 1.0}, kHigh, 1.0);
                                   }),
                                   {seed});
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_GT(std::max(out.result.tree.centre.front().z, out.result.tree.centre.back().z), 11.0F);
}

TEST(Joins, ARootWithTwoClicksRunsToBothEnds) {
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 5}, 0.8);
  seed.points.push_back({{6.4, 6.4, 7}, 0.8});
  const TrackResult out = trackOne(straightTube(0.8), {seed});
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_LT(out.result.tree.centre.front().z, 1.5F);
  EXPECT_GT(out.result.tree.centre.back().z, 11.0F);
}

TEST(Joins, ARootThatRunsIntoATreeHangsOnIt) {
  // the second seed names no parent, and its track comes to the first vessel
  const TrackResult out = trackOne(
      tee(0.7), {seedAt("trunk", {6.4, 6.4, 2.5}, 1.2), seedAt("arm", {10.5, 6.4, 6.4}, 0.7)});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  EXPECT_GE(out.result.tree.branches[1].parentNode, 0);
  EXPECT_GT(out.result.tree.centre.back().x, 11.0F);
  expectNoLongEdge(out.result.tree);
}

TEST(Joins, EndsSayWhyTheyAreThere) {
  const TrackResult tube = trackOne(straightTube(0.8), {seedAt("tube", {6.4, 6.4, 6}, 0.8)});
  ASSERT_EQ(tube.ends.size(), 2u);
  EXPECT_TRUE(tube.ends[0].isStart);
  EXPECT_FALSE(tube.ends[1].isStart);
  EXPECT_EQ(tube.ends[0].goesOn, 0);
  EXPECT_EQ(tube.ends[1].goesOn, 0);
  EXPECT_LT(tube.ends[0].position.z(), 1.5);

  // beyond the tube lies a ball, which is lumen and no tube
  const Volume volume = draw([](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, 6}, 0.6),
                    (p - Vector3d(6.4, 6.4, 8.3)).norm() - 2.5);
  });
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 2}, 0.6);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(volume, {seed});
  ASSERT_EQ(out.ends.size(), 1u);
  EXPECT_NE(out.ends[0].reason, StopReason::LeftVolume);
  EXPECT_GT(out.ends[0].goesOn, 2.0);
}

/// The data that a search for paths needs.
struct Searched {
  explicit Searched(const Distance& distance) : volume(draw(distance)) {}
  Volume volume;
  BsplineVolume spline{volume};
  TrackOptions options;
  Progress silent;
  TrackContext context{spline, options, 0, silent};
  LumenLevels levels{1000, 500};
};

TEST(Paths, KeepToTheLumenRoundACorner) {
  const Searched searched(tubeAlong({{3, 6.4, 1}, {3, 6.4, 10}, {10, 6.4, 10}}, 0.7));
  const PathGoal goal{{10, 6.4, 10}, 0};
  const auto path = findPath(searched.context, searched.levels, {3, 6.4, 2}, {&goal, 1}, 12);
  ASSERT_TRUE(path.has_value());
  EXPECT_LT(path->outside, 0.2);
  EXPECT_NEAR(path->length, 15, 1.5);
  for (const Vector3d& p : path->points)
    EXPECT_LT(tubeAlong({{3, 6.4, 1}, {3, 6.4, 10}, {10, 6.4, 10}}, 0.7)(p), 0.1);
}

TEST(Paths, ThePreferredGoalIsTakenUnlessAnotherIsMuchNearer) {
  const Searched searched(tubeAlong({kLow, kHigh}, 0.7));
  const auto goalOf = [&](double surcharge) {
    const PathGoal goals[] = {{{6.4, 6.4, 9}, 0}, {{6.4, 6.4, 4}, surcharge}};
    return findPath(searched.context, searched.levels, {6.4, 6.4, 6}, goals, 8)->goal;
  };
  EXPECT_EQ(goalOf(0), 1u);
  EXPECT_EQ(goalOf(3), 0u);
}

TEST(Paths, NoGoalWithinReachIsNoPath) {
  const Searched searched(tubeAlong({kLow, kHigh}, 0.7));
  const PathGoal goal{{6.4, 6.4, 11}, 0};
  EXPECT_FALSE(findPath(searched.context, searched.levels, {6.4, 6.4, 2}, {&goal, 1}, 4));
  EXPECT_FALSE(findPath(searched.context, searched.levels, {-40, 6.4, 2}, {&goal, 1}, 4));
}

TEST(PathsBeyond, OneLeadsToEachArmOfAFork) {
  const Searched searched([](const Vector3d& p) {
    return std::min({capsule(p, kLow, {6.4, 6.4, 5}, 0.6),
                     capsule(p, {6.4, 6.4, 5}, {10, 6.4, 10}, 0.6),
                     capsule(p, {6.4, 6.4, 5}, {3, 6.4, 10}, 0.6)});
  });
  PathStart start;
  start.place = {6.4, 6.4, 4};
  start.behind.push_back({{6.4, 6.4, 3.5}, 1});
  start.closed.push_back({{6.4, 6.4, 2.5}, 1});
  const PathsBeyond beyond = pathsBeyond(searched.context, searched.levels, start, 5);
  ASSERT_EQ(beyond.paths.size(), 2u);
  EXPECT_NEAR(beyond.visible, 5, 0.3);
  for (const Path& path : beyond.paths) {
    EXPECT_GT(path.points.back().z(), 6.5);
    EXPECT_NEAR(path.breadth, 0.6, 0.25);
  }
  EXPECT_LT(beyond.paths[0].points.back().x() * beyond.paths[1].points.back().x(), 6.4 * 6.4);
}

TEST(PathsBeyond, CrossAnotherVesselOnceAndAhead) {
  const Searched searched([](const Vector3d& p) {
    return std::min(capsule(p, kLow, kHigh, 0.6), capsule(p, {1, 6.4, 6}, {12, 6.4, 6}, 0.6));
  });
  PathStart start;
  start.place = {6.4, 6.4, 4.5};
  start.behind.push_back({{6.4, 6.4, 4}, 1});
  start.closed.push_back({{6.4, 6.4, 3}, 1});
  for (double x = 1; x <= 12; x += 0.3) start.others.push_back({{x, 6.4, 6}, 0.8});
  start.through = 2;
  const PathsBeyond beyond = pathsBeyond(searched.context, searched.levels, start, 5);
  ASSERT_EQ(beyond.paths.size(), 1u);
  EXPECT_NEAR(beyond.paths[0].points.back().x(), 6.4, 0.6);
  EXPECT_GT(beyond.paths[0].points.back().z(), 8.0);
  start.through = 0.2;
  EXPECT_TRUE(pathsBeyond(searched.context, searched.levels, start, 5).paths.empty());
}

// Where a child hangs on its parent, by tracks that are given (docs/method.md, section 1.12).
/// A node with twelve points on its wall.
TrackedNode nodeAt(const Vector3d& centre, const Vector3d& direction, double radius) {
  TrackedNode node;
  node.centre = centre;
  node.direction = direction;
  node.radius = radius;
  node.height = 0.4;
  const auto [e1, e2] = planeBasis(direction);
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.5235987755982988 * i;
    const Vector3d p = centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    node.points.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return node;
}

/// Nodes along z, upward or downward.
TrackedBranch alongZ(double x, double from, double to, double radius) {
  TrackedBranch branch;
  const Vector3d direction = from < to ? Vector3d::UnitZ() : Vector3d(-Vector3d::UnitZ());
  const int count = static_cast<int>(std::abs(to - from) / 0.4) + 1;
  for (int i = 0; i < count; ++i)
    branch.nodes.push_back(nodeAt({x, 6.4, from + 0.4 * i * direction.z()}, direction, radius));
  return branch;
}

// A child beside its parent, with dark tissue between the two, that leaves it 4 mm farther up.
TEST(JoinToParent, TheParentsNodeIsWhereTheLumenLeadsNotTheNearestInAStraightLine) {
  const Volume volume = drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min({capsule(p, kLow, kHigh, 1.0), capsule(p, {9, 6.4, 0.4}, {9, 6.4, 7}, 0.6),
                     capsule(p, {9, 6.4, 7}, {6.4, 6.4, 7}, 0.6)});
  });
  const BsplineVolume spline(volume);
  const TrackOptions options;
  Progress silent;
  const TrackContext context(spline, options, 0, silent);
  std::vector<TrackedBranch> all{alongZ(6.4, 0.6, 12, 1.0), alongZ(9, 3, 1, 0.6)};
  all[1].parentBranch = 0;
  TrackRun run(context, Random(3));
  TrackedBranch child = all[1];
  joinToParent(run, all, {}, child);
  ASSERT_EQ(child.parentBranch, 0);
  ASSERT_GE(child.parentNode, 0);
  EXPECT_NEAR(all[0].nodes[static_cast<std::size_t>(child.parentNode)].centre.z(), 7.0, 0.8);
  EXPECT_GT(child.nodes.front().centre.z(), 6.0);
  EXPECT_LT(child.nodes.front().centre.x(), 8.0) << "the first node leaves the parent";
}

}  // namespace
}  // namespace lumen::convert
