// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/joining.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/stages/tracking/follow_courses.h"
#include "converters/stages/tracking/lumen_paths.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// An edge longer than this share of the mean height, and than the lesser radius, is a gap.
constexpr double kGapHeights = 1.25;
/// Distance around the ends in which a path is searched for, in straight distances and at least in
/// radii.
constexpr double kReachDistances = 1.5, kLeastReachRadii = 6;
/// Largest share of a path outside of the lumen; beyond it a straight line is as good.
constexpr double kOutsideShare = 0.5;
/// The longest bridge to a parent's wall where the volume shows no lumen, in radii of the child.
constexpr double kLongestBridgeRadii = 12;
/// Radii of the child that its named parent may be farther away than another branch of that tree.
constexpr double kSurchargeRadii = 3;

/// A line from a place to one of several goals.
struct Line {
  std::vector<Vector3d> points;
  std::size_t goal = 0;
  bool isSeen = true;  ///< the volume shows it
};

/// The path through the lumen from a place to one of some goals; a straight line to the first goal
/// if there is none.
Line lineTo(const TrackContext& context, const LumenLevels& levels, const Vector3d& from,
            std::span<const PathGoal> goals, double radius) {
  const Vector3d& straight = goals[0].position;
  const double distance = (straight - from).norm();
  auto path = findPath(context, levels, from, goals,
                       std::max(kReachDistances * distance, kLeastReachRadii * radius));
  if (path && path->length < kLongestDetour * distance + 2 * radius &&
      path->outside < kOutsideShare * path->length)
    return {std::move(path->points), path->goal};
  return {{from, straight}, 0, false};
}

/// Cuts off the nodes of a branch in its parent's core, up to the place where it leaves the
/// parent's lumen for the first time, and joins the rest to the parent where it was cut.
void cutInCore(const TrackedBranch& parent, TrackedBranch& branch) {
  std::size_t cut = 0;
  for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
    const ChainPoint at = closestOnChain(parent.nodes, branch.nodes[i].centre);
    if (at.distance > at.radius) break;
    if (at.distance > kCore * at.radius) continue;
    cut = i + 1;
    branch.parentNode = static_cast<int>(at.node);
  }
  cut = std::min(cut, branch.nodes.size() - 1);
  branch.nodes.erase(branch.nodes.begin(), branch.nodes.begin() + static_cast<std::ptrdiff_t>(cut));
  branch.clickNode -= std::min(branch.clickNode, cut);
}

/// Makes a child a root, and records the reason.
void makeRoot(TrackedBranch& branch, const ChainPoint& parent) {
  branch.unjoined = "its first node lies " + fixedText(parent.distance - parent.radius, 1) +
                    " mm from it, and the volume shows no lumen between them";
  branch.parentBranch = branch.parentNode = -1;
}

/// The lumen of a branch at its first node.
LumenLevels levelsAtStart(const TrackContext& context, const TrackedBranch& branch) {
  const std::size_t near = std::min(branch.nodes.size(), kLevelNodes);
  return measureLevels(context.volume, std::span(branch.nodes).first(near));
}

bool isGap(const TrackedNode& a, const TrackedNode& b) {
  const double distance = (b.centre - a.centre).norm();
  return distance > kGapHeights * 0.5 * (a.height + b.height) &&
         distance > std::min(a.radius, b.radius);
}

}  // namespace

void fillGaps(TrackRun& run, TrackedBranch& branch) {
  std::vector<TrackedNode> filled;
  const std::vector<TrackedNode>& nodes = branch.nodes;
  std::size_t click = branch.clickNode;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i == branch.clickNode) click = filled.size();
    filled.push_back(nodes[i]);
    if (i + 1 == nodes.size() || !isGap(nodes[i], nodes[i + 1])) continue;
    const std::size_t low = i + 1 > kLevelNodes ? i + 1 - kLevelNodes : 0;
    const std::size_t high = std::min(nodes.size(), i + 1 + kLevelNodes);
    const LumenLevels levels =
        measureLevels(run.context.volume, std::span(nodes).subspan(low, high - low));
    const Vector3d to = nodes[i + 1].centre;
    const PathGoal goal{to, 0};
    const Line line = lineTo(run.context, levels, nodes[i].centre, {&goal, 1}, nodes[i].radius);
    auto between = nodesAlong(run, line.points, nodes[i].radius, nodes[i + 1].radius, nullptr);
    std::move(between.begin(), between.end(), std::back_inserter(filled));
  }
  branch.nodes = std::move(filled);
  branch.clickNode = click;
}

std::optional<PathToBranch> pathToOther(const TrackContext& context,
                                        std::span<const TrackedBranch> all,
                                        std::span<const int> others, const TrackedBranch& branch) {
  const TrackedNode& first = branch.nodes.front();
  const double farthest = kLongestBridgeRadii * first.radius;
  std::vector<PathGoal> goals;
  std::vector<int> owner;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int other : others)
    for (const TrackedNode& node : all[static_cast<std::size_t>(other)].nodes) {
      const double distance = (node.centre - first.centre).norm();
      if (distance - node.radius > farthest) continue;
      nearest = std::min(nearest, distance);
      goals.push_back({node.centre, 0});
      owner.push_back(other);
    }
  if (goals.empty()) return std::nullopt;
  const auto path = findPath(context, levelsAtStart(context, branch), first.centre, goals,
                             std::max(kReachDistances * nearest, kLeastReachRadii * first.radius));
  if (!path || path->length > kLongestDetour * nearest + 2 * first.radius ||
      path->outside > 2 * first.radius)
    return std::nullopt;
  return PathToBranch{owner[path->goal], path->outside};
}

void joinToParent(TrackRun& run, std::span<const TrackedBranch> all, std::span<const int> others,
                  TrackedBranch& branch) {
  const TrackedNode first = branch.nodes.front();
  const LumenLevels levels = levelsAtStart(run.context, branch);
  const auto at = [&](int index) -> const TrackedBranch& {
    return all[static_cast<std::size_t>(index)];
  };
  const ChainPoint straight = closestOnChain(at(branch.parentBranch).nodes, first.centre);
  std::vector<PathGoal> goals{{straight.position, 0}};
  std::vector<int> owner{branch.parentBranch};
  const auto add = [&](int index, double surcharge) {
    for (const TrackedNode& node : at(index).nodes) {
      goals.push_back({node.centre, surcharge});
      owner.push_back(index);
    }
  };
  add(branch.parentBranch, 0);
  for (const int index : others) add(index, kSurchargeRadii * first.radius);
  const Line line = lineTo(run.context, levels, first.centre, goals, first.radius);
  if (!line.isSeen && straight.distance - straight.radius > kLongestBridgeRadii * first.radius) {
    makeRoot(branch, straight);
    return;
  }
  branch.parentBranch = owner[line.goal];
  const TrackedBranch& parent = at(branch.parentBranch);
  std::vector<Vector3d> outward(line.points.rbegin(), line.points.rend());
  const ChainPoint root = closestOnChain(parent.nodes, outward.front());
  branch.parentNode = static_cast<int>(root.node);
  outward.front() = parent.nodes[root.node].centre;
  auto link = nodesAlong(run, outward, std::min(first.radius, root.radius), first.radius, &parent);
  branch.clickNode += link.size();
  branch.nodes.insert(branch.nodes.begin(), std::make_move_iterator(link.begin()),
                      std::make_move_iterator(link.end()));
  cutInCore(parent, branch);
}

}  // namespace lumen::convert
