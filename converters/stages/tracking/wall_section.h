// SPDX-License-Identifier: Apache-2.0
// The wall of vessels that are not round, or that taper (docs/method.md, section 1.11).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// The wall around a measured node as an ellipse about `axis` (unit) that may taper along it: the node
/// with the wall points that this explains, its middle, and the radius of a disc of the same area.
/// Empty where it explains hardly more than the node's cylinder does, or less of the way around, or
/// not even two thirds of that.
std::optional<TrackedNode> fitSection(const TrackContext& context, const TrackedNode& node,
                                      const Eigen::Vector3d& axis, TrackWorkspace& workspace);

/// Gives the measured nodes of a vessel such walls, where the volume shows them.
void fitSections(const TrackContext& context, std::vector<TrackedNode>& nodes,
                 TrackWorkspace& workspace);

}  // namespace lumen::convert
