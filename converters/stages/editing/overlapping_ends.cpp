// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/overlapping_ends.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kOppositeCosine = 0.7;    // of the directions out of both tips
constexpr double kLikeOverlapRadii = 1.4;  // ratio of the radii of one vessel on both sides

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
  if (a.outward.dot(b.outward) > -kOppositeCosine) return std::nullopt;
  if (std::max(a.radius, b.radius) > kLikeOverlapRadii * std::min(a.radius, b.radius))
    return std::nullopt;
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

}  // namespace lumen::convert
