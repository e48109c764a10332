// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/joining.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "converters/stages/tracking/nodes_along.h"
#include "converters/stages/tracking/way.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Of the mean height and of the lesser radius: edges longer than both are gaps.
constexpr double kLongEdge = 1.25, kLongStep = 1.0;
/// Nodes at an end of a track that tell the levels of its lumen.
constexpr std::size_t kLevelNodes = 12;
/// Of the straight distance: a longer way is one along other vessels; and how far around the ends
/// it is looked for, at least so many radii.
constexpr double kLongestWay = 2.5, kReach = 1.5, kLeastReach = 6;
/// Of a way: the share outside of the lumen up to which it is followed rather than a straight line.
constexpr double kOutside = 0.5;
/// Of the parent's radius: a way that has come so near to its axis has arrived.
constexpr double kCore = 0.5;

/// Radii of the child: the longest bridge to its parent's wall where the volume shows no lumen.
constexpr double kLongestBridge = 12;

/// Radii of the child: so much farther may its named parent be than another branch of that tree.
constexpr double kSurcharge = 3;

/// A line from one place to another, and which goal it leads to.
struct Line {
  std::vector<Vector3d> points;
  std::size_t goal = 0;
  bool isSeen = true;  ///< the volume shows it
};

/// The way through the lumen from a place to one of some goals; straight to the first goal if there
/// is none.
Line lineTo(const TrackContext& context, const LumenLevels& levels, const Vector3d& from,
            std::span<const Goal> goals, double radius) {
  const Vector3d& straight = goals[0].position;
  const double distance = (straight - from).norm();
  auto way =
      findWay(context, levels, from, goals, std::max(kReach * distance, kLeastReach * radius));
  if (way && way->length < kLongestWay * distance + 2 * radius &&
      way->outside < kOutside * way->length)
    return {std::move(way->points), way->goal};
  return {{from, straight}, 0, false};
}

/// Cuts off what a branch has in its parent's core before it leaves the parent's lumen for the first
/// time, and hangs the rest where it was cut.
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

/// A way that comes to a branch behind its first node would lead back along the branch: cuts off the
/// way from there on, and what the branch has before.
void cutDetour(std::vector<TrackedNode>& way, TrackedBranch& branch) {
  for (std::size_t w = 0; w < way.size(); ++w) {
    const ChainPoint at = closestOnChain(branch.nodes, way[w].centre);
    if (at.node == 0 || at.distance > kCore * at.radius) continue;
    way.resize(w);
    branch.nodes.erase(branch.nodes.begin(),
                       branch.nodes.begin() + static_cast<std::ptrdiff_t>(at.node));
    branch.clickNode -= std::min(branch.clickNode, at.node);
    return;
  }
}

/// Makes a child a root, and says why.
void leaveAlone(TrackedBranch& branch, const ChainPoint& parent) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "its first node lies %.1f mm from it, and the volume shows no lumen between them",
                parent.distance - parent.radius);
  branch.unjoined = text.data();
  branch.parentBranch = branch.parentNode = -1;
}

/// The lumen of a branch at its first node.
LumenLevels levelsAtStart(const TrackContext& context, const TrackedBranch& branch) {
  const std::size_t near = std::min(branch.nodes.size(), kLevelNodes);
  return levelsOf(context.volume, std::span(branch.nodes).first(near));
}

bool isGap(const TrackedNode& a, const TrackedNode& b) {
  const double distance = (b.centre - a.centre).norm();
  return distance > kLongEdge * 0.5 * (a.height + b.height) &&
         distance > kLongStep * std::min(a.radius, b.radius);
}

}  // namespace

void fillGaps(const TrackContext& context, TrackedBranch& branch, Random& random,
              TrackWorkspace& workspace) {
  std::vector<TrackedNode> filled;
  const std::vector<TrackedNode>& nodes = branch.nodes;
  std::size_t click = branch.clickNode;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i == branch.clickNode) click = filled.size();
    filled.push_back(nodes[i]);
    if (i + 1 == nodes.size() || !isGap(nodes[i], nodes[i + 1])) continue;
    const std::size_t low = i + 1 > kLevelNodes ? i + 1 - kLevelNodes : 0;
    const std::size_t high = std::min(nodes.size(), i + 1 + kLevelNodes);
    const LumenLevels levels = levelsOf(context.volume, std::span(nodes).subspan(low, high - low));
    const Vector3d to = nodes[i + 1].centre;
    const Goal goal{to, 0};
    const Line line = lineTo(context, levels, nodes[i].centre, {&goal, 1}, nodes[i].radius);
    auto between = nodesAlong(context, line.points, nodes[i].radius, nodes[i + 1].radius, nullptr,
                              random, workspace);
    std::move(between.begin(), between.end(), std::back_inserter(filled));
  }
  branch.nodes = std::move(filled);
  branch.clickNode = click;
}

std::optional<LumenWay> wayToOther(const TrackContext& context, std::span<const TrackedBranch> all,
                                   std::span<const int> others, const TrackedBranch& branch) {
  const TrackedNode& first = branch.nodes.front();
  const double farthest = kLongestBridge * first.radius;
  std::vector<Goal> goals;
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
  const auto way = findWay(context, levelsAtStart(context, branch), first.centre, goals,
                           std::max(kReach * nearest, kLeastReach * first.radius));
  if (!way || way->length > kLongestWay * nearest + 2 * first.radius ||
      way->outside > 2 * first.radius)
    return std::nullopt;
  return LumenWay{owner[way->goal], way->outside};
}

void joinToParent(const TrackContext& context, std::span<const TrackedBranch> all,
                  std::span<const int> others, TrackedBranch& branch, Random& random,
                  TrackWorkspace& workspace) {
  const TrackedNode first = branch.nodes.front();
  const LumenLevels levels = levelsAtStart(context, branch);
  const auto at = [&](int index) -> const TrackedBranch& {
    return all[static_cast<std::size_t>(index)];
  };
  const ChainPoint straight = closestOnChain(at(branch.parentBranch).nodes, first.centre);
  std::vector<Goal> goals{{straight.position, 0}};
  std::vector<int> owner{branch.parentBranch};
  const auto add = [&](int index, double surcharge) {
    for (const TrackedNode& node : at(index).nodes) {
      goals.push_back({node.centre, surcharge});
      owner.push_back(index);
    }
  };
  add(branch.parentBranch, 0);
  for (const int index : others) add(index, kSurcharge * first.radius);
  const Line line = lineTo(context, levels, first.centre, goals, first.radius);
  if (!line.isSeen && straight.distance - straight.radius > kLongestBridge * first.radius) {
    leaveAlone(branch, straight);
    return;
  }
  branch.parentBranch = owner[line.goal];
  const TrackedBranch& parent = at(branch.parentBranch);
  std::vector<Vector3d> outward(line.points.rbegin(), line.points.rend());
  const ChainPoint root = closestOnChain(parent.nodes, outward.front());
  branch.parentNode = static_cast<int>(root.node);
  outward.front() = parent.nodes[root.node].centre;
  auto way = nodesAlong(context, outward, std::min(first.radius, root.radius), first.radius,
                        &parent, random, workspace);
  cutDetour(way, branch);
  branch.clickNode += way.size();
  branch.nodes.insert(branch.nodes.begin(), std::make_move_iterator(way.begin()),
                      std::make_move_iterator(way.end()));
  cutInCore(parent, branch);
}

}  // namespace lumen::convert
