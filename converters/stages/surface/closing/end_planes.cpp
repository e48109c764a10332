// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/closing/end_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

constexpr int kContinuedWithin = 2;  // edges: how near a node must be to continue a vessel

bool isModelled(const formats::Case& source, std::uint32_t node) {
  return source.models->offset[node] < source.models->offset[node + 1];
}

// The first or last node of the branch that has a model.
std::uint32_t endOfModels(const formats::Case& source, const formats::Branch& branch, bool last) {
  for (std::uint32_t i = 0; i < branch.nodeCount; ++i) {
    const std::uint32_t node = branch.firstNode + (last ? branch.nodeCount - 1 - i : i);
    if (isModelled(source, node)) return node;
  }
  return branch.firstNode;
}

// True if one of `nodes` lies within 60 degrees of `direction`, seen from `node`.
bool isContinued(const formats::Case& source, std::uint32_t node, const Eigen::Vector3d& direction,
                 const std::vector<std::uint32_t>& nodes) {
  const Eigen::Vector3d centre = toEigen(source.tree.centre[node]);
  return std::any_of(nodes.begin(), nodes.end(), [&](std::uint32_t other) {
    const Eigen::Vector3d away = toEigen(source.tree.centre[other]) - centre;
    return other != node && isModelled(source, other) && away.dot(direction) > 0.5 * away.norm();
  });
}

// True if an edge of the tree that is not its branch's own leads to the node.
bool isJoined(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
              std::uint32_t node) {
  const auto others = edges.of(node);
  return std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
    const bool isParent = tree.parent[node] == static_cast<std::int32_t>(other);
    return !isParent && (tree.branch[other] != tree.branch[node] ||
                         tree.parent[other] != static_cast<std::int32_t>(node));
  });
}

Eigen::Vector3d outwardAt(const formats::Case& source, std::uint32_t node, bool last) {
  const Eigen::Vector3d along = toEigen(source.tree.direction[node]).normalized();
  return last ? along : Eigen::Vector3d(-along);
}

}  // namespace

double reachOfEnd(const formats::CenterlineTree& tree, std::uint32_t node) {
  return 0.5 * double{std::max(tree.height[node], tree.radius[node])};
}

std::optional<EndPlane> freeEnd(const formats::Case& source, const formats::Neighbours& edges,
                                std::uint32_t branch, bool last) {
  const formats::CenterlineTree& tree = source.tree;
  const formats::Branch& vessel = tree.branches[branch];
  if (vessel.kind == formats::BranchKind::Aneurysm || vessel.nodeCount == 0) return std::nullopt;
  if (!last && vessel.parentNode != formats::kNoParent) return std::nullopt;
  const std::uint32_t node = endOfModels(source, vessel, last);
  const Eigen::Vector3d outward = outwardAt(source, node, last);
  if (!isModelled(source, node) ||
      isContinued(source, node, outward, edges.within(node, kContinuedWithin)))
    return std::nullopt;
  const Eigen::Vector3d centre = toEigen(tree.centre[node]) + reachOfEnd(tree, node) * outward;
  return EndPlane{branch, node, !last, centre, outward};
}

std::vector<EndPlane> endPlanes(const formats::Case& source) {
  const formats::Neighbours edges(source.tree);
  std::vector<EndPlane> planes;
  for (std::uint32_t branch = 0; branch < source.tree.branches.size(); ++branch)
    for (const bool last : {false, true}) {
      const auto plane = freeEnd(source, edges, branch, last);
      if (plane && !(last && isJoined(source.tree, edges, plane->node))) planes.push_back(*plane);
    }
  return planes;
}

std::optional<EndPlane> movedInward(const formats::Case& source, const EndPlane& plane,
                                    double distance) {
  const formats::CenterlineTree& tree = source.tree;
  const formats::Branch& branch = tree.branches[plane.branch];
  const std::int64_t step = plane.isInlet ? 1 : -1, first = branch.firstNode;
  EndPlane moved = plane;
  for (std::int64_t node = plane.node; node >= first && node < first + branch.nodeCount;
       node += step) {
    const auto here = static_cast<std::uint32_t>(node);
    const Eigen::Vector3d ahead = toEigen(tree.centre[here]) - moved.centre;
    const double length = ahead.norm();
    moved.normal = outwardAt(source, here, !plane.isInlet);
    if (length >= distance) {
      if (length > 0) moved.centre += distance / length * ahead;
      return moved;
    }
    moved.centre += ahead;
    distance -= length;
  }
  return std::nullopt;
}

std::vector<std::uint32_t> nodesNearEnd(const formats::Case& source, const EndPlane& plane,
                                        double reach) {
  const formats::CenterlineTree& tree = source.tree;
  const formats::Branch& branch = tree.branches[plane.branch];
  std::uint32_t first = plane.node, last = plane.node;
  const auto length = [&tree](std::uint32_t node) {  // from the node to the one behind it
    return (toEigen(tree.centre[node + 1]) - toEigen(tree.centre[node])).norm();
  };
  for (double along = 0; first > branch.firstNode && (along += length(first - 1)) <= reach;)
    --first;
  for (double along = 0;
       last + 1 < branch.firstNode + branch.nodeCount && (along += length(last)) <= reach;)
    ++last;
  std::vector<std::uint32_t> nodes(last - first + 1);
  std::iota(nodes.begin(), nodes.end(), first);
  return nodes;
}

}  // namespace lumen::convert
