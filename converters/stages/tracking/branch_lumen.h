// SPDX-License-Identifier: Apache-2.0
// The lumen of a tracked vessel as the balls of its nodes, and stretches of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"

namespace lumen::convert {

/// The fewest nodes with a cylinder that a vessel has.
constexpr std::size_t kFewestFitted = 4;

inline bool isFitted(const TrackedNode& node) {
  return node.origin != formats::NodeOrigin::Bridged;
}

/// A vessel that is tracked, with the box of its lumen. The branch must outlive it.
struct BranchLumen {
  explicit BranchLumen(const TrackedBranch& branch) : nodes(branch.nodes) {
    for (const TrackedNode& node : nodes) box.add(node.centre, node.radius);
  }
  /// The radius of the vessel around a point (mm, LPS) in its lumen or within `rim` mm of it; 0
  /// farther outside.
  [[nodiscard]] double radiusAround(const Eigen::Vector3d& point, double rim = 0) const {
    if ((box.gap(point).array() > rim).any()) return 0;
    const ChainPoint at = closestOnChain(nodes, point);
    return at.distance < at.radius + rim ? at.radius : 0;
  }

  std::span<const TrackedNode> nodes;
  Box3d box;
};

/// The greatest radius of the vessels in whose lumen, or within `rim` mm of it, a point lies; 0 if
/// there is none.
inline double radiusAround(std::span<const BranchLumen> vessels, const Eigen::Vector3d& point,
                           double rim = 0) {
  double radius = 0;
  for (const BranchLumen& vessel : vessels)
    radius = std::max(radius, vessel.radiusAround(point, rim));
  return radius;
}

/// True if a point lies in the lumen of a vessel other than the one at `own`.
inline bool isInAnother(std::span<const BranchLumen> vessels, std::size_t own,
                        const Eigen::Vector3d& point) {
  for (std::size_t i = 0; i < vessels.size(); ++i)
    if (i != own && vessels[i].radiusAround(point) > 0) return true;
  return false;
}

/// Leaves the nodes `first` to `end` - 1 of a branch, without those at both ends at which no
/// cylinder fits.
inline void keepStretch(TrackedBranch& branch, std::size_t first, std::size_t end) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  while (first < end && !isFitted(nodes[first])) ++first;
  while (first < end && !isFitted(nodes[end - 1])) --end;
  nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(end), nodes.end());
  nodes.erase(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(first));
  branch.clickNode = nodes.size() / 2;
}

}  // namespace lumen::convert
