// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/onward.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "converters/stages/tracking/branch_start.h"
#include "converters/stages/tracking/follow.h"
#include "converters/stages/tracking/nodes_along.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/smoothing.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::NodeOrigin;
using formats::StopReason;

/// Of the radius, beyond which voxels are outside of a lumen; the blur of its rim comes on top.
constexpr double kRim = 1.15;
/// Radii of way, at least so many voxels, that a way leads on for: as far as a hairpin takes to turn.
constexpr double kOnward[] = {7, 14}, kLeastVoxels = 6;
/// Radii before the tip whose lumen is closed only behind the tip.
constexpr double kNearTip = 3;
/// Radii beyond the tip within which a way may enter another vessel.
constexpr double kThrough = 3;
/// Nodes at a tip that tell the levels of its lumen.
constexpr std::size_t kLevelNodes = 12;
/// Of the last radius: the range of that of a way's end.
constexpr double kNarrowest = 0.6, kWidest = 1.5;
/// Of the nodes along a way: the share that must have been fitted, and how many of the last.
constexpr double kFitted = 0.3;
constexpr std::size_t kLastFitted = 3;
/// Of the strength before: the least of what is found.
constexpr double kLikeStrength = 0.5;
/// Radii of a tip's own rounded end: a lumen that is visible for less has ended.
constexpr double kRoundEnd = 3.5;

/// Voxels of way around a click, by turns, and the shares of it at which there are places.
constexpr double kAround[] = {6, 12};
constexpr double kPlaces[] = {1.0 / 3, 2.0 / 3, 1};
/// Of the contrast: the wall's level.
constexpr double kHalf = 0.5;

/// The tip of a track, which must not go back into itself.
Outset outsetOf(const TrackContext& context, std::span<const TrackedNode> nodes,
                std::span<const Ball> others) {
  const TrackedNode& tip = nodes.back();
  Outset outset{tip.centre, courseOf(nodes), {}, {}, {}, kThrough * tip.radius};
  outset.others.assign(others.begin(), others.end());
  std::vector<Ball> own;
  addBalls(nodes, context.volume.geometry(), own);
  for (const Ball& ball : own) {
    const bool isNear = (ball.centre - tip.centre).norm() < kNearTip * tip.radius;
    (isNear ? outset.behind : outset.closed).push_back(ball);
  }
  return outset;
}

/// True if what was found along a way is the vessel that was tracked so far.
bool isVessel(std::span<const TrackedNode> before, std::span<const TrackedNode> found) {
  const auto isFitted = [](const TrackedNode& n) { return n.origin == NodeOrigin::Measured; };
  if (found.size() < kLastFitted) return false;
  const auto last = found.last(kLastFitted);
  if (!std::all_of(last.begin(), last.end(), isFitted)) return false;
  const auto fitted = std::count_if(found.begin(), found.end(), isFitted);
  if (static_cast<double>(fitted) < kFitted * static_cast<double>(found.size())) return false;
  const double least = kLikeStrength * recentMeans(before).strength;
  return std::all_of(last.begin(), last.end(),
                     [&](const TrackedNode& n) { return n.strength >= least; });
}

/// Nodes that may be given up at a tip that has strayed into another vessel.
constexpr std::size_t kStrayed = 12;

/// How many nodes a track has before those at its tip that lie in others' lumen.
std::size_t countBeforeOthers(std::span<const TrackedNode> nodes, std::span<const Ball> others) {
  const auto isIn = [&](const TrackedNode& node) {
    return std::any_of(others.begin(), others.end(), [&](const Ball& ball) {
      return (node.centre - ball.centre).norm() < ball.radius;
    });
  };
  std::size_t count = nodes.size();
  while (count > 1 && isIn(nodes[count - 1])) --count;
  return count;
}

/// A node of another width at the end of a way, as where a narrow vessel opens into a wide one, if it
/// leads on.
std::optional<TrackedNode> fitEnd(const TrackContext& context, const Way& way, Random& random,
                                  TrackWorkspace& workspace) {
  const Vector3d& end = way.points.back();
  const Vector3d ahead = end - way.points[way.points.size() / 2];
  if (!(ahead.norm() > 0)) return std::nullopt;
  const NodeGuess guess{end, ahead.normalized(), way.breadth, true, way.breadth};
  auto node = fitNode(context, guess, context.options.inlierRate, random, workspace).node;
  if (!node || stepsFrom(context, *node, nullptr, random, workspace) < kTrialSteps)
    return std::nullopt;
  return node;
}

/// The straightest first.
void sortByTurn(std::vector<Way>& ways, const Vector3d& course) {
  const auto turn = [&](const Way& way) {
    return -(way.points.back() - way.points.front()).normalized().dot(course);
  };
  std::stable_sort(ways.begin(), ways.end(),
                   [&](const Way& a, const Way& b) { return turn(a) < turn(b); });
}

/// Appends nodes along the first of some ways that leads through this vessel.
bool takeWay(const TrackContext& context, std::vector<TrackedNode>& nodes,
             std::span<const Way> ways, Random& random, TrackWorkspace& workspace) {
  const double radius = nodes.back().radius;
  for (const Way& way : ways) {
    const double end = std::clamp(way.breadth, kNarrowest * radius, kWidest * radius);
    auto found = nodesAlong(context, way.points, radius, end, nullptr, random, workspace);
    if (!isVessel(nodes, found)) {
      if (way.breadth < kWidest * radius) continue;
      auto last = fitEnd(context, way, random, workspace);
      if (!last) continue;
      found.push_back(std::move(*last));
    }
    std::move(found.begin(), found.end(), std::back_inserter(nodes));
    return true;
  }
  return false;
}

/// Appends nodes along a way on from the tip of a branch, and writes how far there seem to be any.
bool leadOn(const TrackContext& context, TrackedBranch& branch, std::span<const Ball> others,
            Random& random, TrackWorkspace& workspace) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  const LumenLevels levels =
      levelsOf(context.volume, std::span(nodes).last(std::min(nodes.size(), kLevelNodes)));
  const TrackedNode& tip = nodes.back();
  const double least = kLeastVoxels * context.volume.geometry().voxelSize();
  const Outset outset = outsetOf(context, nodes, others);
  for (const double radii : kOnward) {
    const double distance = std::max(radii * tip.radius, least);
    WaysOnward onward = waysOnward(context, levels, outset, distance);
    branch.goesOn = onward.visible > kRoundEnd * tip.radius ? onward.visible : 0;
    if (onward.isAll) return false;
    sortByTurn(onward.ways, courseOf(nodes));
    if (takeWay(context, nodes, onward.ways, random, workspace)) return true;
  }
  return false;
}

LumenLevels levelsAt(const TrackContext& context, const Vector3d& click) {
  SeedBranch seed;
  seed.points.push_back({click, std::nullopt});
  const double contrast =
      contrastAtClicks(context.volume, {seed}, context.options, context.progress);
  const double value = context.volume.sample(context.volume.geometry().indexFromWorld(click));
  return {value, value - (context.options.dark ? -kHalf : kHalf) * contrast};
}

}  // namespace

void addBalls(std::span<const TrackedNode> nodes, const VolumeGeometry& geometry,
              std::vector<Ball>& balls) {
  const double blur = 0.5 * geometry.voxelSize();
  for (const TrackedNode& node : nodes) balls.push_back({node.centre, kRim * node.radius + blur});
}

void goOnward(const TrackContext& context, TrackedBranch& branch, std::span<const Ball> others,
              std::span<const TrackedBranch* const> finished, Random& random,
              TrackWorkspace& workspace) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  while (branch.stopReason == StopReason::NoValidCylinder ||
         branch.stopReason == StopReason::TurnedBack ||
         branch.stopReason == StopReason::MetBranch) {
    const std::size_t before = nodes.size(), kept = countBeforeOthers(nodes, others);
    if (before - kept > kStrayed) return;
    std::vector<TrackedNode> strayed(
        std::make_move_iterator(nodes.begin() + static_cast<std::ptrdiff_t>(kept)),
        std::make_move_iterator(nodes.end()));
    nodes.resize(kept);
    if (!leadOn(context, branch, others, random, workspace)) {
      std::move(strayed.begin(), strayed.end(), std::back_inserter(nodes));
      return;
    }
    followVessel(context, branch, finished, random, workspace);
    branch.goesOn = 0;
    if (nodes.size() <= before) return;
  }
}

std::vector<NearbyPlace> placesAround(const TrackContext& context, const Vector3d& click,
                                      std::span<const Ball> others) {
  if (!context.volume.geometry().containsWorld(click)) return {};
  const LumenLevels levels = levelsAt(context, click);
  Outset outset;
  outset.place = click;
  outset.closed.assign(others.begin(), others.end());
  std::vector<NearbyPlace> places;
  for (const double voxels : kAround) {
    const WaysOnward onward =
        waysOnward(context, levels, outset, voxels * context.volume.geometry().voxelSize());
    for (const double share : kPlaces)
      for (const Way& way : onward.ways) {
        const auto last = static_cast<double>(way.points.size() - 1);
        const auto at = static_cast<std::size_t>(std::round(share * last));
        if (at == 0) continue;
        const Vector3d ahead = way.points[at] - way.points[at / 2];
        if (ahead.norm() > 0) places.push_back({way.points[at], ahead.normalized()});
      }
  }
  return places;
}

}  // namespace lumen::convert
