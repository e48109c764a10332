// SPDX-License-Identifier: Apache-2.0
// Rules about the next node of a track, by its nodes so far (docs/method.md, section 1.5).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Radii beyond an end that it reaches: of a face of the volume, before which the rays see half of
/// the wall and the centre stalls, and of another vessel, in those of that one.
constexpr double kEndRadii = 1.5;
/// True if a vessel leaves the volume at a node, along its direction times `sign`.
bool isAtFace(const VolumeGeometry& geometry, const TrackedNode& node, double sign = 1);
/// Least strength of a vessel beyond a gap or a tip, as a share of the recent mean.
constexpr double kLikeStrength = 0.5;

/// Means over the last nodes of a track.
struct RecentMeans {
  double inlierRate = 0, strength = 0, radius = 0;
};
RecentMeans recentMeans(std::span<const TrackedNode> nodes);

/// The guess `steps` prediction steps ahead of a node.
NodeGuess predictNode(const TrackOptions& options, const TrackedNode& from, double steps,
                      const Eigen::Vector3d& direction);

/// The direction of a track (unit): between its last direction and the chord over its last radius
/// and a half. On a thin vessel the two together err less than either alone.
Eigen::Vector3d trackDirection(std::span<const TrackedNode> nodes);

/// True for a poor fit that is suddenly wide: it lies around the vessel and another that touches
/// it.
bool isSwollen(const TrackOptions& options, std::span<const TrackedNode> nodes,
               const TrackedNode& next);

/// The number of nodes before the place where a track that `next` would lead back onto itself has
/// turned round; empty if `next` does not lead back. It leads back if it is behind the last node,
/// or in the core of an earlier one although the track from there is longer than a bend of a
/// vessel.
std::optional<std::size_t> findTurningPoint(std::span<const TrackedNode> nodes,
                                            const TrackedNode& next);

/// Drops the last nodes if they are much wider than those before: such nodes are fitted to the
/// rounded end of the vessel.
void dropTip(std::vector<TrackedNode>& nodes);

}  // namespace lumen::convert
