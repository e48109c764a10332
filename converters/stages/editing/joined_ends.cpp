// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "converters/geometry/disjoint_sets.h"
#include "converters/stages/editing/correct_topology.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kVoidRadii = 3;     // of both ends together: no longer gap is bridged unseen
constexpr double kVoidAhead = 0.85;  // of an end and the line to the other
constexpr double kVoidFacing = 0.8;  // of both ends: a vessel may bend within the gap
constexpr double kVoidRatio = 1.25;  // of the radii on both sides, and of those on one
constexpr double kLongRadii = 8;     // a tree that is shorter than that has no sure direction

struct FreeEnd {
  std::uint32_t node = 0, tree = 0;
  Vector3d position, outward;
  double radius = 0;
  double treeLength = 0;  // mm
};

/// Two ends by their numbers.
struct Facing {
  std::size_t a = 0, b = 0;
  double cost = 0;
};

std::vector<FreeEnd> freeEnds(const NodeGraph& graph) {
  std::vector<FreeEnd> ends;
  std::uint32_t tree = 0;
  for (const std::vector<std::uint32_t>& nodes : graph.endsOfTrees()) {
    const double length = nodes.empty() ? 0 : graph.treeLength(nodes.front());
    for (const std::uint32_t node : nodes)
      // radii that differ as much on one side as they may across show no vessel that goes on
      if (const auto arm = graph.armFrom(node); arm && arm->radiusRatio <= kVoidRatio)
        ends.push_back(
            {node, tree, graph.position(node), graph.outwardAt(node), arm->radius, length});
    ++tree;
  }
  return ends;
}

/// Cost of one vessel through two ends; empty if they are none.
std::optional<double> costAcross(const FreeEnd& a, const FreeEnd& b) {
  const Vector3d gap = b.position - a.position;
  const double length = gap.norm(), wide = a.radius + b.radius;
  const double ratio = std::max(a.radius, b.radius) / std::min(a.radius, b.radius);
  const double least = std::min(a.treeLength, b.treeLength);
  if (length > kVoidRadii * wide || ratio > kVoidRatio) return std::nullopt;
  if (least < std::max(length, 0.5 * kLongRadii * wide)) return std::nullopt;
  const double facing = -a.outward.dot(b.outward);
  const double ahead = std::min(a.outward.dot(gap), -b.outward.dot(gap)) / length;
  if (facing < kVoidFacing || !(ahead >= kVoidAhead)) return std::nullopt;
  return length / wide + 2 * (2 - facing - ahead) + 2 * std::log(ratio);
}

/// Pairs of ends of two trees that may be one vessel, the surest first.
std::vector<Facing> facingPairs(const NodeGraph& graph, const std::vector<FreeEnd>& ends) {
  std::vector<Facing> found;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j)
      if (ends[i].tree != ends[j].tree && !graph.areApart(ends[i].node, ends[j].node))
        if (const auto cost = costAcross(ends[i], ends[j])) found.push_back({i, j, *cost});
  std::stable_sort(found.begin(), found.end(),
                   [](const Facing& x, const Facing& y) { return x.cost < y.cost; });
  return found;
}

}  // namespace

std::vector<Vector3d> joinAcrossVoids(NodeGraph& graph) {
  const std::vector<FreeEnd> ends = freeEnds(graph);
  std::vector<bool> isUsed(ends.size(), false);
  DisjointSets trees(ends.empty() ? 0 : ends.back().tree + 1);
  std::vector<Vector3d> places;
  for (const auto& [i, j, cost] : facingPairs(graph, ends)) {
    if (isUsed[i] || isUsed[j] || trees.find(ends[i].tree) == trees.find(ends[j].tree)) continue;
    isUsed[i] = isUsed[j] = true;
    trees.join(ends[i].tree, ends[j].tree);
    graph.join(ends[i].node, ends[j].node);
    places.push_back(ends[i].position);
  }
  return places;
}

namespace {

using Eigen::Vector3d;

/// Gap up to the axis of the other vessel, of both radii: what is left of a vessel behind its cut is
/// a bump of a wall, and dropped, as long as it is no longer than both are wide.
constexpr double kSideGapRadii = 2;
/// Way along the vessels from an end to the place ahead of it, of both radii: a shorter one is a fork
/// that the end itself hangs on.
constexpr double kSideLoopRadii = 8;

using IsOpen = std::function<bool(const Vector3d&, const Vector3d&)>;

/// The one of the nodes whose ball an end, straight on, enters first.
std::optional<std::uint32_t> nodeAhead(const NodeGraph& graph, std::uint32_t end,
                                       const std::vector<std::uint32_t>& nodes,
                                       const IsOpen& isOpen) {
  const Vector3d from = graph.position(end), outward = graph.outwardAt(end);
  double least = std::numeric_limits<double>::infinity();
  std::optional<std::uint32_t> best;
  for (const std::uint32_t node : nodes) {
    if (graph.areApart(end, node)) continue;
    const Vector3d gap = graph.position(node) - from;
    const double length = gap.norm(), wide = graph.radius(end) + graph.radius(node);
    const double toWall = length - graph.radius(node);
    if (toWall >= least || length > kSideGapRadii * wide) continue;
    const double along = outward.dot(gap);
    const double beside = (gap - along * outward).norm();
    if (along < kAheadOfEnd * length || beside > graph.radius(node)) continue;
    const auto path = graph.pathLength(end, node);
    if ((path && *path < kSideLoopRadii * wide) || !isOpen(from, graph.position(node))) continue;
    least = toWall;
    best = node;
  }
  return best;
}

}  // namespace

std::vector<Vector3d> joinIntoSides(NodeGraph& graph, const IsOpen& isOpen) {
  std::vector<Vector3d> places;
  const std::vector<std::uint32_t> sides = graph.nodesAwayFromEnds();
  for (const std::vector<std::uint32_t>& ends : graph.endsOfTrees())
    for (const std::uint32_t end : ends) {
      if (graph.isLinked(end) || !graph.armFrom(end)) continue;
      const auto node = nodeAhead(graph, end, sides, isOpen);
      if (!node) continue;
      graph.join(end, *node);
      places.push_back(graph.position(end));
    }
  return places;
}

namespace {

using Eigen::Vector3d;

/// A tip, and the nodes from it on up to the first fork.
struct Tip {
  std::vector<std::uint32_t> nodes;
  Vector3d outward;
  double radius = 0;
};

/// How many first nodes of each of two tips lie in the vessel of the other.
struct Overlap {
  std::size_t a = 0, b = 0;
};

std::vector<Tip> findTips(const NodeGraph& graph) {
  std::vector<Tip> tips;
  for (const std::vector<std::uint32_t>& ends : graph.endsOfTrees())
    for (const std::uint32_t end : ends) {
      const auto arm = graph.armFrom(end);
      std::vector<std::uint32_t> nodes = graph.unforkedFrom(end);
      if (arm && !nodes.empty() && !graph.isLinked(end))
        tips.push_back({std::move(nodes), graph.outwardAt(end), arm->radius});
    }
  return tips;
}

/// Number of first nodes of a tip whose centres lie in the lumen of another's vessel.
std::size_t countWithin(const NodeGraph& graph, const Tip& tip, const Tip& other) {
  const auto isWithin = [&](std::uint32_t node) {
    return std::any_of(other.nodes.begin(), other.nodes.end(), [&](std::uint32_t near) {
      return (graph.position(node) - graph.position(near)).norm() < graph.radius(near);
    });
  };
  return static_cast<std::size_t>(std::find_if_not(tip.nodes.begin(), tip.nodes.end(), isWithin) -
                                  tip.nodes.begin());
}

std::optional<Overlap> overlapOf(const NodeGraph& graph, const Tip& a, const Tip& b) {
  if (graph.areApart(a.nodes.front(), b.nodes.front())) return std::nullopt;
  if (a.outward.dot(b.outward) > -kFacingCosine) return std::nullopt;
  if (std::max(a.radius, b.radius) > kLikeRadii * std::min(a.radius, b.radius)) return std::nullopt;
  const bool isOneVessel =
      std::find(a.nodes.begin(), a.nodes.end(), b.nodes.front()) != a.nodes.end();
  if (isOneVessel) return std::nullopt;
  const Overlap overlap{countWithin(graph, a, b), countWithin(graph, b, a)};
  const bool isPartly =
      overlap.a > 0 && overlap.b > 0 && overlap.a < a.nodes.size() && overlap.b < b.nodes.size();
  return isPartly ? std::optional(overlap) : std::nullopt;
}

/// Makes one vessel of two, whose nodes are given from their tips on.
void joinPair(NodeGraph& graph, std::span<const std::uint32_t> a, std::span<const std::uint32_t> b,
              const Overlap& overlap) {
  const auto inA = a.first(overlap.a), inB = b.first(overlap.b);
  const bool dropsA = graph.countMeasured(inA) < graph.countMeasured(inB);
  graph.drop(dropsA ? inA : inB);
  graph.join(a[dropsA ? overlap.a : 0], b[dropsA ? 0 : overlap.b]);
}

}  // namespace

std::vector<Vector3d> joinOverlappingEnds(NodeGraph& graph) {
  std::vector<Tip> tips = findTips(graph);
  std::vector<bool> isUsed(tips.size(), false);
  std::vector<Vector3d> places;
  for (std::size_t a = 0; a < tips.size(); ++a)
    for (std::size_t b = a + 1; b < tips.size() && !isUsed[a]; ++b) {
      const auto overlap = isUsed[b] ? std::nullopt : overlapOf(graph, tips[a], tips[b]);
      if (!overlap) continue;
      isUsed[a] = isUsed[b] = true;
      places.push_back(graph.position(tips[a].nodes.front()));
      joinPair(graph, tips[a].nodes, tips[b].nodes, *overlap);
      for (std::size_t i = 0; i < tips.size(); ++i)  // the other tips of both vessels
        if (!isUsed[i]) tips[i].nodes = graph.unforkedFrom(tips[i].nodes.front());
    }
  return places;
}

namespace {

/// Lumens meet if their axes are no farther apart than this many times both radii, which may be wrong
/// by a tenth.
constexpr double kMeeting = 1.1;

/// Whether a vessel goes on through a node, not counting the neighbour `excluded`: two of its arms
/// lead away from one another by more than a right angle, as those of a fork seldom do. Its width
/// shows nothing, as cylinders are too wide where another vessel touches.
bool goesOn(const NodeGraph& graph, std::uint32_t node, std::uint32_t excluded) {
  std::vector<Eigen::Vector3d> arms;
  for (const std::uint32_t next : graph.neighbours(node))
    if (next != excluded)
      if (const auto arm = graph.armInto(node, next)) arms.push_back(arm->direction);
  for (std::size_t i = 0; i < arms.size(); ++i)
    for (std::size_t k = i + 1; k < arms.size(); ++k)
      if (arms[i].dot(arms[k]) < 0) return true;
  return false;
}

/// The nodes of a path from one place to another, both included.
using Stretch = std::span<const std::uint32_t>;

/// Whether all nodes of a stretch touch the vessel that goes on through its first.
bool touchesAlong(const NodeGraph& graph, Stretch stretch) {
  const std::vector<std::uint32_t> vessel = graph.throughAllBut(stretch[0], stretch[1]);
  const double wide = graph.radius(stretch.back());
  return std::all_of(stretch.begin(), stretch.end(), [&](std::uint32_t node) {
    return std::any_of(vessel.begin(), vessel.end(), [&](std::uint32_t near) {
      return (graph.position(node) - graph.position(near)).norm() <=
             kMeeting * (graph.radius(near) + wide);
    });
  });
}

/// A stretch that an aneurysm hangs on is none, as it would lose its place.
bool isFalseConnection(const NodeGraph& graph, Stretch stretch) {
  if (std::any_of(stretch.begin(), stretch.end(),
                  [&](std::uint32_t node) { return graph.hasAneurysm(node); }))
    return false;
  const std::vector<std::uint32_t> back(stretch.rbegin(), stretch.rend());
  return goesOn(graph, stretch[0], stretch[1]) && goesOn(graph, back[0], back[1]) &&
         (touchesAlong(graph, stretch) || touchesAlong(graph, back));
}

/// The shortest false connection on a path; empty if it has none.
Stretch falseConnectionOn(const NodeGraph& graph, Stretch path) {
  Stretch best;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!graph.isFork(path[i])) continue;
    std::size_t k = i + 1;
    while (k + 1 < path.size() && !graph.isFork(path[k])) ++k;
    const Stretch stretch = path.subspan(i, k - i + 1);
    const bool isShorter = best.empty() || stretch.size() < best.size();
    if (isShorter && graph.isFork(path[k]) && isFalseConnection(graph, stretch)) best = stretch;
  }
  return best;
}

}  // namespace

void cutFalseConnections(NodeGraph& graph) {
  for (const auto& [a, b] : graph.takeLinks()) {
    const std::vector<std::uint32_t> path = graph.pathBetween(a, b);
    if (path.size() < 3) {  // no loop, or an edge already
      graph.link(a, b);
      continue;
    }
    graph.connect(a, b);
    const Stretch contact = falseConnectionOn(graph, path);
    if (contact.empty()) {
      graph.cut(a, b);
      graph.link(a, b);
    } else if (contact.size() == 2) {
      graph.cut(contact[0], contact[1]);
    } else {
      graph.drop(contact.subspan(1, contact.size() - 2));
    }
  }
}

}  // namespace lumen::convert
