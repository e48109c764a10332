// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/node_cell.h"

#include <algorithm>

#include "converters/common/vectors.h"

namespace lumen::convert {
namespace {

constexpr int kContinuedWithin = 2;  // edges: how near a node must be to continue a vessel

bool hasModel(const formats::Case& source, std::uint32_t node) {
  return source.models->offset[node] < source.models->offset[node + 1];
}

// The first or last node of the branch that has a model.
std::uint32_t endOfModels(const formats::Case& source, const formats::Branch& branch, bool last) {
  for (std::uint32_t i = 0; i < branch.nodeCount; ++i) {
    const std::uint32_t node = branch.firstNode + (last ? branch.nodeCount - 1 - i : i);
    if (hasModel(source, node)) return node;
  }
  return branch.firstNode;
}

// True if one of `nodes` lies within 60 degrees of `direction`, seen from `node`.
bool isContinued(const formats::Case& source, std::uint32_t node, const Eigen::Vector3d& direction,
                 const std::vector<std::uint32_t>& nodes) {
  const Eigen::Vector3d centre = toEigen(source.tree.centre[node]);
  return std::any_of(nodes.begin(), nodes.end(), [&](std::uint32_t other) {
    const Eigen::Vector3d away = toEigen(source.tree.centre[other]) - centre;
    return other != node && hasModel(source, other) && away.dot(direction) > 0.5 * away.norm();
  });
}

void addFreeEnds(const formats::Case& source, std::uint32_t node,
                 const std::vector<std::uint32_t>& nodes, std::vector<HalfSpace>& spaces) {
  const formats::CenterlineTree& tree = source.tree;
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  if (branch.kind == formats::BranchKind::Aneurysm) return;
  const Eigen::Vector3d along = toEigen(tree.direction[node]).normalized();
  const double reach = 0.5 * double{std::max(tree.height[node], tree.radius[node])};
  for (const bool last : {false, true}) {
    if (!last && branch.parentNode != formats::kNoParent) continue;
    if (node != endOfModels(source, branch, last)) continue;
    const Eigen::Vector3d outward = last ? along : Eigen::Vector3d(-along);
    if (isContinued(source, node, outward, nodes)) continue;
    spaces.push_back({outward, outward.dot(toEigen(tree.centre[node])) + reach});
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
  addFreeEnds(source, node, edges.within(node, kContinuedWithin), cell.ends);
  return cell;
}

}  // namespace lumen::convert
