// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/into_sides.h"

#include <limits>
#include <optional>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Gap up to the axis of the other vessel, of both radii: what is left of a vessel behind its cut is
/// a bump of a wall, and dropped, as long as it is no longer than both are wide.
constexpr double kSideGapRadii = 2;
constexpr double kSideAhead = 0.8;  // cosine, of an end and the way to the other vessel
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
    const Vector3d gap = graph.position(node) - from;
    const double length = gap.norm(), wide = graph.radius(end) + graph.radius(node);
    const double toWall = length - graph.radius(node);
    if (toWall >= least || length > kSideGapRadii * wide) continue;
    const double along = outward.dot(gap);
    const double beside = (gap - along * outward).norm();
    if (along < kSideAhead * length || beside > graph.radius(node)) continue;
    const auto way = graph.wayBetween(end, node);
    if ((way && *way < kSideLoopRadii * wide) || !isOpen(from, graph.position(node))) continue;
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

}  // namespace lumen::convert
