// SPDX-License-Identifier: Apache-2.0
// Vessels that end just before the side of another, which they join (docs/method.md, section 1.14).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {

/// Joins ends of a graph to the vessel that lies ahead of them, by a bridge to its axis, or by a link
/// behind a bridge where that closes a loop. A skeleton cuts each loop at one place; if that is near
/// a fork, the short rest beyond the cut is taken for a bump of the wall there. `isOpen`: whether
/// only lumen lies between two points, mm, LPS. Directions of edges are stale afterwards. Returns the
/// places of the joined ends, mm, LPS.
std::vector<Eigen::Vector3d> joinIntoSides(
    NodeGraph& graph,
    const std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>& isOpen);

}  // namespace lumen::convert
