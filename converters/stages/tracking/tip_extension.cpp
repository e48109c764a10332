// SPDX-License-Identifier: Apache-2.0
// Declared in track_by_depth.h.
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "converters/stages/tracking/follow_courses.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/track_by_depth.h"
#include "converters/stages/tracking/track_steps.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::NodeOrigin;
using formats::StopReason;

/// Lengths of the paths beyond a tip in radii, by turns, as far as a hairpin takes to turn; and
/// their least length in voxels.
constexpr double kBeyondRadii[] = {7, 14}, kBeyondVoxels = 6;
/// Radii around the tip within which the track's lumen is closed only behind the tip, and within
/// which a path may enter another vessel.
constexpr double kNearTipRadii = 3;
/// Share of the nodes along a path that must have been fitted, and the number of last ones.
constexpr double kFittedShare = 0.3;
constexpr std::size_t kLastFittedNodes = 3;
/// Radii of a tip's own rounded end: a lumen that is visible for less has ended.
constexpr double kRoundEndRadii = 3.5;
/// Nodes that may be given up at a tip that has strayed into another vessel.
constexpr std::size_t kStrayedNodes = 12;

/// The tip of a track, from which paths must not lead back into the track.
PathStart pathStartAtTip(const TrackContext& context, std::span<const TrackedNode> nodes,
                         std::span<const WorldBall> others) {
  const TrackedNode& tip = nodes.back();
  PathStart start{tip.centre, trackDirection(nodes), {}, {}, {}, kNearTipRadii * tip.radius};
  start.others.assign(others.begin(), others.end());
  std::vector<WorldBall> own;
  addLumen(nodes, context.volume.geometry(), own);
  for (const WorldBall& ball : own) {
    const bool isNear = (ball.centre - tip.centre).norm() < kNearTipRadii * tip.radius;
    (isNear ? start.behind : start.closed).push_back(ball);
  }
  return start;
}

/// True if the nodes found along a path belong to the vessel of the track.
bool isSameVessel(std::span<const TrackedNode> before, std::span<const TrackedNode> found) {
  const auto isFitted = [](const TrackedNode& n) { return n.origin == NodeOrigin::Measured; };
  if (found.size() < kLastFittedNodes) return false;
  const auto last = found.last(kLastFittedNodes);
  if (!std::all_of(last.begin(), last.end(), isFitted)) return false;
  const auto fitted = std::count_if(found.begin(), found.end(), isFitted);
  if (static_cast<double>(fitted) < kFittedShare * static_cast<double>(found.size())) return false;
  const double least = kLikeStrength * recentMeans(before).strength;
  return std::all_of(last.begin(), last.end(),
                     [&](const TrackedNode& n) { return n.strength >= least; });
}

/// The number of nodes of a track before those at its tip that lie in the lumen of others.
std::size_t countBeforeOthers(std::span<const TrackedNode> nodes,
                              std::span<const WorldBall> others) {
  const auto isIn = [&](const TrackedNode& node) {
    return std::any_of(others.begin(), others.end(), [&](const WorldBall& ball) {
      return (node.centre - ball.centre).norm() < ball.radius;
    });
  };
  std::size_t count = nodes.size();
  while (count > 1 && isIn(nodes[count - 1])) --count;
  return count;
}

/// A node of another width at the end of a path, as where a narrow vessel opens into a wide one, if
/// a track goes on from it.
std::optional<TrackedNode> fitEnd(TrackRun& run, const Path& path) {
  const Vector3d& end = path.points.back();
  const Vector3d ahead = end - path.points[path.points.size() / 2];
  if (!(ahead.norm() > 0)) return std::nullopt;
  const NodeGuess guess{end, ahead.normalized(), path.breadth, true, path.breadth};
  auto node = fitNode(run, guess, run.context.options.inlierRate).node;
  if (!node || trialSteps(run, *node, nullptr) < kTrialSteps) return std::nullopt;
  return node;
}

void sortStraightestFirst(std::vector<Path>& paths, const Vector3d& course) {
  const auto turn = [&](const Path& path) {
    return -(path.points.back() - path.points.front()).normalized().dot(course);
  };
  std::stable_sort(paths.begin(), paths.end(),
                   [&](const Path& a, const Path& b) { return turn(a) < turn(b); });
}

/// Appends nodes along the first of some paths that leads through this vessel.
bool appendAlongPath(TrackRun& run, std::vector<TrackedNode>& nodes, std::span<const Path> paths) {
  const double radius = nodes.back().radius;
  for (const Path& path : paths) {
    const double end = std::clamp(path.breadth, kNarrowest * radius, kWidest * radius);
    auto found = nodesAlong(run, path.points, radius, end, nullptr);
    if (!isSameVessel(nodes, found)) {
      if (path.breadth < kWidest * radius) continue;
      auto last = fitEnd(run, path);
      if (!last) continue;
      found.push_back(std::move(*last));
    }
    const TrackedNode& tip = nodes.back();
    const auto ahead = std::find_if(found.begin(), found.end(),
                                    [&](const TrackedNode& node) { return isAhead(tip, node); });
    if (ahead == found.end()) continue;
    std::move(ahead, found.end(), std::back_inserter(nodes));
    return true;
  }
  return false;
}

/// Appends nodes along a path beyond the tip of a branch, and records the length for which the
/// lumen is seen to continue.
bool extendOnce(TrackRun& run, TrackedBranch& branch, std::span<const WorldBall> others) {
  const TrackContext& context = run.context;
  std::vector<TrackedNode>& nodes = branch.nodes;
  const LumenLevels levels =
      measureLevels(context.volume, std::span(nodes).last(std::min(nodes.size(), kLevelNodes)));
  const TrackedNode& tip = nodes.back();
  const double least = kBeyondVoxels * context.volume.geometry().voxelSize();
  const PathStart start = pathStartAtTip(context, nodes, others);
  for (const double radii : kBeyondRadii) {
    const double distance = std::max(radii * tip.radius, least);
    PathsBeyond beyond = pathsBeyond(context, levels, start, distance);
    branch.goesOn = beyond.visible > kRoundEndRadii * tip.radius ? beyond.visible : 0;
    if (beyond.isAll) return false;
    sortStraightestFirst(beyond.paths, trackDirection(nodes));
    if (appendAlongPath(run, nodes, beyond.paths)) return true;
  }
  return false;
}

}  // namespace

void extendTip(TrackRun& run, TrackedBranch& branch, std::span<const WorldBall> others,
               FinishedBranches finished) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  while (branch.stopReason == StopReason::NoValidCylinder ||
         branch.stopReason == StopReason::TurnedBack ||
         branch.stopReason == StopReason::MetBranch) {
    const std::size_t before = nodes.size(), kept = countBeforeOthers(nodes, others);
    if (before - kept > kStrayedNodes) return;
    std::vector<TrackedNode> strayed(
        std::make_move_iterator(nodes.begin() + static_cast<std::ptrdiff_t>(kept)),
        std::make_move_iterator(nodes.end()));
    nodes.resize(kept);
    if (!extendOnce(run, branch, others)) {
      std::move(strayed.begin(), strayed.end(), std::back_inserter(nodes));
      return;
    }
    trackToEnd(run, branch, finished);
    branch.goesOn = 0;
    if (nodes.size() <= before) return;
  }
}

}  // namespace lumen::convert
