// SPDX-License-Identifier: Apache-2.0
// What a path so far says about its next node (docs/method.md, section 1.5).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Means over the last nodes of a path.
struct RecentMeans {
  double inlierRate = 0, strength = 0, radius = 0;
};
RecentMeans recentMeans(std::span<const TrackedNode> nodes);

/// The guess `steps` prediction steps ahead of a node.
NodeGuess predictNode(const TrackOptions& options, const TrackedNode& from, double steps,
                      const Eigen::Vector3d& direction);

/// Where a path is heading (unit): between its last direction and the chord over its last radius
/// and a half. On a thin vessel the two together err less than either alone.
Eigen::Vector3d courseOf(std::span<const TrackedNode> nodes);

/// True for a poor fit that is suddenly wide: it is drawn around the vessel and one that touches
/// it.
bool isSwollen(const TrackOptions& options, std::span<const TrackedNode> nodes,
               const TrackedNode& next);

/// Where a path that `next` would lead back onto itself has turned round, as the number of nodes
/// before; empty if it does not lead back. It does if `next` is behind the last node, or in the
/// core of an earlier one although the way to that is longer than a bend of a vessel would make it.
std::optional<std::size_t> findTurningPoint(std::span<const TrackedNode> nodes,
                                            const TrackedNode& next);

/// Drops the last nodes if they are much wider than those before: they saw the rounded end of the
/// vessel.
void dropTip(std::vector<TrackedNode>& nodes);

}  // namespace lumen::convert
