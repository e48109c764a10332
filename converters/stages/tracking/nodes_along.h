// SPDX-License-Identifier: Apache-2.0
// Nodes along a line that is known to lead through a vessel (docs/method.md, section 1.12).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Nodes along a polyline (mm, LPS) strictly between its ends, half a radius apart. They are fitted
/// where the volume shows a wall of about the expected radius, which goes from `first` to `last`
/// mm; elsewhere, and inside of the lumen of `parent` (which may be null), they are bridged. Throws
/// Error(Cancelled).
std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Eigen::Vector3d> line,
                                    double first, double last, const TrackedBranch* parent);

/// Nodes along a course (mm, LPS) whose expected radius is known at each of its points, mm, strictly
/// between its ends, half a radius apart and fitted where the volume shows a wall. Nodes that are
/// refused are tried again with the radius of the nodes around them, and then along the curve between
/// those that fit, on which they stay if they are bridged.
std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Eigen::Vector3d> line,
                                    std::span<const double> radii);

/// The node that fits at a bridged one, of about its radius and course and between its neighbours;
/// empty if there is none.
std::optional<TrackedNode> nodeBetween(TrackRun& run, const TrackedNode& before,
                                       const TrackedNode& bridged, const TrackedNode& after);

}  // namespace lumen::convert
