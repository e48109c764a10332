// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/patches/node_cell.h"

#include "converters/base/vectors.h"
#include "converters/stages/surface/end_planes.h"

namespace lumen::convert {
namespace {

bool hasModel(const formats::Case& source, std::uint32_t node) {
  return source.models->offset[node] < source.models->offset[node + 1];
}

void addFreeEnds(const formats::Case& source, const formats::Neighbours& edges, std::uint32_t node,
                 std::vector<HalfSpace>& spaces) {
  for (const bool last : {false, true}) {
    const auto end = freeEnd(source, edges, source.tree.branch[node], last);
    if (end && end->node == node)
      spaces.push_back({end->normal, end->normal.dot(toEigen(source.tree.centre[node])) +
                                         reachOfEnd(source.tree, node)});
  }
}

}  // namespace

std::optional<NodeCell> nodeCell(const formats::Case& source, const formats::Neighbours& edges,
                                 std::span<const std::uint32_t> neighbours, std::uint32_t node) {
  const formats::CenterlineTree& tree = source.tree;
  const Eigen::Vector3d centre = toEigen(tree.centre[node]);
  const double radius = tree.radius[node];
  NodeCell cell;
  for (const std::uint32_t other : neighbours) {
    if (!hasModel(source, other)) continue;
    const Eigen::Vector3d away = toEigen(tree.centre[other]) - centre;
    const double distance = away.norm(), otherRadius = tree.radius[other];
    if (distance > 0) {
      const double power = (radius - otherRadius) * (radius + otherRadius);
      const Eigen::Vector3d normal = away / distance;
      cell.radical.push_back({normal, normal.dot(centre) + 0.5 * (distance + power / distance)});
    } else if (otherRadius > radius || (otherRadius == radius && other < node)) {
      return std::nullopt;  // two nodes in one place: the wider one draws, or else the first
    }
  }
  addFreeEnds(source, edges, node, cell.ends);
  return cell;
}

}  // namespace lumen::convert
