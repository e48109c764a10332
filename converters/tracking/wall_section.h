// SPDX-License-Identifier: Apache-2.0
// The wall of vessels that are not round (docs/method.md, section 1.11).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "converters/tracking/node_fit.h"

namespace lumen::convert {

/// The wall around a measured node as an ellipse about `axis` (unit): the node with the wall points
/// that this explains, their mean place across the axis and the radius of a disc of the same area.
/// Empty where the ellipse explains hardly more than the node's cylinder does, or no more of the
/// way around, or not even half of it.
std::optional<TrackedNode> fitSection(const TrackContext& context, const TrackedNode& node,
                                      const Eigen::Vector3d& axis, TrackWorkspace& workspace);

/// Gives the measured nodes of a vessel such walls, where the volume shows them.
void fitSections(const TrackContext& context, std::vector<TrackedNode>& nodes,
                 TrackWorkspace& workspace);

}  // namespace lumen::convert
