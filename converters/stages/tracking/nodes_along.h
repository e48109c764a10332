// SPDX-License-Identifier: Apache-2.0
// Nodes along a line that is known to lead through a vessel (docs/method.md, section 1.12).
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Nodes along a polyline (mm, LPS) between its ends, which they leave out, half a radius apart.
/// Fitted where the volume shows a wall like the one that radii from `first` to `last` mm ask for;
/// elsewhere, and inside of the lumen of `parent` (which may be null), bridged. Throws
/// Error(Cancelled).
std::vector<TrackedNode> nodesAlong(const TrackContext& context,
                                    std::span<const Eigen::Vector3d> line, double first,
                                    double last, const TrackedBranch* parent, Random& random,
                                    TrackWorkspace& workspace);

}  // namespace lumen::convert
