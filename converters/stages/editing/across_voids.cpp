// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/across_voids.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "converters/geometry/disjoint_sets.h"

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
std::vector<Facing> facingPairs(const std::vector<FreeEnd>& ends) {
  std::vector<Facing> found;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j)
      if (ends[i].tree != ends[j].tree)
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
  for (const auto& [i, j, cost] : facingPairs(ends)) {
    if (isUsed[i] || isUsed[j] || trees.find(ends[i].tree) == trees.find(ends[j].tree)) continue;
    isUsed[i] = isUsed[j] = true;
    trees.join(ends[i].tree, ends[j].tree);
    graph.join(ends[i].node, ends[j].node);
    places.push_back(ends[i].position);
  }
  return places;
}

}  // namespace lumen::convert
