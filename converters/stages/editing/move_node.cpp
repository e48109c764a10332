// SPDX-License-Identifier: Apache-2.0
// moveNode() of edit.h.
#include <algorithm>
#include <array>
#include <cmath>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/editing/checks.h"
#include "converters/stages/editing/edit.h"
#include "converters/stages/editing/editable_case.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;

/// Nodes along the branch whose wall points may lie in a node's section: cylinders overlap by half.
constexpr std::uint32_t kBeside = 4;

/// The part of a vessel that a node stands for: between the planes halfway to its neighbours.
struct Section {
  Vector3d centre, axis;
  double behind, ahead;  ///< mm

  [[nodiscard]] bool holds(const Vector3d& p) const {
    const double along = (p - centre).dot(axis);
    return along > -behind && along < ahead;
  }
};

/// A node's place in its branch.
struct Place {
  std::uint32_t node, first, end;  ///< in the branch [first, end)

  [[nodiscard]] bool hasPrevious() const { return node > first; }
  [[nodiscard]] bool hasNext() const { return node + 1 < end; }
};

Section measureSection(const EditableCase& edited, const Place& place) {
  const EditableNode& node = edited.nodes[place.node];
  const Vector3d centre = toEigen(node.centre), axis = toEigen(node.direction);
  const auto half = [&](bool isThere, std::uint32_t other) {
    if (!isThere) return 0.5 * double{node.height};
    return 0.5 * (toEigen(edited.nodes[other].centre) - centre).norm();
  };
  return {centre, axis, half(place.hasPrevious(), place.node - 1),
          half(place.hasNext(), place.node + 1)};
}

/// Drops the wall points of a node, and those of its neighbours in one of two sections.
void dropPoints(const Case& value, const Place& place, const std::array<Section, 2>& sections,
                EditableCase& edited) {
  if (!value.points) return;
  const formats::PointSets& points = *value.points;
  edited.isGone.assign(points.position.size(), false);
  const std::uint32_t low = std::max(place.first + kBeside, place.node) - kBeside;
  const std::uint32_t high = std::min(place.end, place.node + kBeside + 1);
  for (std::uint32_t node = low; node < high; ++node)
    for (std::uint32_t k = points.offset[node]; k < points.offset[node + 1]; ++k) {
      const Vector3d p = toEigen(points.position[k]);
      edited.isGone[k] = node == place.node || sections[0].holds(p) || sections[1].holds(p);
    }
}

/// The direction between a node's neighbours in its branch; its own if they lie in one place.
formats::Vec3f directionAlong(const EditableCase& edited, const Place& place) {
  const std::uint32_t from = place.hasPrevious() ? place.node - 1 : place.node;
  const std::uint32_t to = place.hasNext() ? place.node + 1 : place.node;
  const Vector3d chord = toEigen(edited.nodes[to].centre) - toEigen(edited.nodes[from].centre);
  return chord.norm() > 0 ? toVec3f(chord.normalized()) : edited.nodes[place.node].direction;
}

std::string placeAndRadius(const Vector3d& p, double radius) {
  return vectorText(p) + " mm and a radius of " + shownNumber(radius, 4) + " mm";
}

}  // namespace

Change moveNode(Case& target, std::uint32_t node, const Vector3d& position, double radius) {
  requireNode(target, node);
  if (!isWithin(position, kFarthest) || !(static_cast<float>(radius) > 0) || !(radius <= kFarthest))
    throw invalidInput("found " + placeAndRadius(position, radius) + " for " +
                       nodeText(target, node) +
                       ", expected a position within a kilometre and a radius above 0");
  const formats::Branch& branch = target.tree.branches[target.tree.branch[node]];
  const Place place{node, branch.firstNode, branch.firstNode + branch.nodeCount};
  EditableCase edited(target);
  const Section before = measureSection(edited, place);
  EditableNode& moved = edited.nodes[node];
  moved.centre = toVec3f(position);
  moved.radius = static_cast<float>(radius);
  moved.direction = directionAlong(edited, place);
  if (branch.kind == formats::BranchKind::Vessel) {
    moved.origin = formats::NodeOrigin::Given;
    moved.inlierRate = 0;
    edited.branches[target.tree.branch[node]].isOther = true;
    dropPoints(target, place, {before, measureSection(edited, place)}, edited);
  }
  return edited.finish(
      target, "moved " + nodeText(target, node) + " to " + placeAndRadius(position, radius));
}

}  // namespace lumen::convert
