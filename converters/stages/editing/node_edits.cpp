// SPDX-License-Identifier: Apache-2.0
// addNodeBehind() and deleteNode() of wall_edits.h.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/editable_case.h"
#include "converters/stages/editing/wall_edits.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;

/// Share of the way between two nodes, on either side of its middle, whose wall points go to a node
/// there.
constexpr double kQuarter = 0.25;

/// The node of each wall point of a case.
std::vector<std::uint32_t> ownersOf(const formats::PointSets& points) {
  std::vector<std::uint32_t> owner;
  owner.reserve(points.position.size());
  for (std::uint32_t node = 0; node + 1 < points.offset.size(); ++node)
    owner.resize(points.offset[node + 1], node);
  return owner;
}

EditableNode between(const EditableNode& a, const EditableNode& b) {
  const Vector3d from = toEigen(a.centre), to = toEigen(b.centre);
  const Vector3d course = toEigen(a.direction) + toEigen(b.direction);
  EditableNode node;
  node.centre = toVec3f(0.5 * (from + to));
  node.direction = course.norm() > 0 ? toVec3f(course.normalized()) : a.direction;
  node.radius = 0.5F * (a.radius + b.radius);
  node.height = 0.5F * (a.height + b.height);
  node.inlierRate = 0.5F * (a.inlierRate + b.inlierRate);
  node.isEdited = a.isEdited && b.isEdited;
  node.system = a.system;
  return node;
}

/// The number of wall points of `from` and `to` that the node between them, `made`, takes.
std::size_t takePoints(const Case& value, std::uint32_t from, std::uint32_t to, std::uint32_t made,
                       EditableCase& edited) {
  if (!value.points) return 0;
  const formats::PointSets& points = *value.points;
  const Vector3d start = toEigen(value.tree.centre[from]),
                 chord = toEigen(value.tree.centre[to]) - start;
  const double length = chord.squaredNorm();
  edited.pointOwner = ownersOf(points);
  std::size_t taken = 0;
  for (const std::uint32_t node : {from, to})
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k) {
      const double share = (toEigen(points.position[k]) - start).dot(chord) / length;
      if (!(std::abs(share - 0.5) <= kQuarter)) continue;
      edited.pointOwner[k] = made;
      ++taken;
    }
  return taken;
}

/// The neighbour in the chain whose centre is nearer to a point.
std::uint32_t nearer(const formats::CenterlineTree& tree, const std::vector<std::uint32_t>& beside,
                     const formats::Vec3f& point) {
  const auto distance = [&](std::uint32_t node) {
    return (toEigen(tree.centre[node]) - toEigen(point)).squaredNorm();
  };
  return *std::min_element(beside.begin(), beside.end(), [&](std::uint32_t a, std::uint32_t b) {
    return distance(a) < distance(b);
  });
}

void requireNoLink(const Case& value, std::uint32_t node) {
  const auto& links = value.tree.links;
  if (std::any_of(links.begin(), links.end(),
                  [node](const auto& link) { return link[0] == node || link[1] == node; }))
    throw invalidInput(nodeText(value, node) +
                       " closes a loop; expected a node without a link to another");
}

}  // namespace

Change addNodeBehind(Case& target, std::uint32_t node) {
  requireNode(target, node);
  const std::uint32_t b = target.tree.branch[node];
  const formats::Branch& branch = target.tree.branches[b];
  if (node + 1 == branch.firstNode + branch.nodeCount)
    throw invalidInput(nodeText(target, node) +
                       " is the last of its vessel; expected one with a node behind it");
  EditableCase edited(target);
  const auto made = static_cast<std::uint32_t>(edited.nodes.size());
  edited.nodes.push_back(between(edited.nodes[node], edited.nodes[node + 1]));
  if (takePoints(target, node, node + 1, made, edited) == 0)
    edited.nodes[made].origin = formats::NodeOrigin::Bridged;
  auto& chain = edited.branches[b].nodes;
  chain.insert(chain.begin() + (node - branch.firstNode) + 1, made);
  edited.branches[b].isOther = true;
  return edited.finish(target, "put a node behind " + nodeText(target, node));
}

Change deleteNode(Case& target, std::uint32_t node) {
  requireNode(target, node);
  const std::uint32_t b = target.tree.branch[node];
  const formats::Branch& branch = target.tree.branches[b];
  if (branch.nodeCount == 1)
    throw invalidInput(nodeText(target, node) +
                       " is the only one of its vessel; delete the vessel instead");
  requireNoLink(target, node);
  std::vector<std::uint32_t> beside;
  if (node > branch.firstNode) beside.push_back(node - 1);
  if (node + 1 < branch.firstNode + branch.nodeCount) beside.push_back(node + 1);
  EditableCase edited(target);
  std::erase(edited.branches[b].nodes, node);
  edited.branches[b].isOther = true;
  for (EditableBranch& other : edited.branches)
    if (other.parent == node) other.parent = beside.front();
  if (target.points) {
    const formats::PointSets& points = *target.points;
    edited.pointOwner = ownersOf(points);
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k)
      edited.pointOwner[k] = nearer(target.tree, beside, points.position[k]);
  }
  return edited.finish(target, "deleted " + nodeText(target, node));
}

}  // namespace lumen::convert
