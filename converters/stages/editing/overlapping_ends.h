// SPDX-License-Identifier: Apache-2.0
// Two tracks that entered the same stretch of a vessel from both sides (docs/method.md, section 1.14).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {

/// Joins pairs of tips that have passed one another within one vessel: the centre of each lies in the
/// lumen of the other's vessel, which is of like width and leads the other way. The stretch that both
/// have is kept of the one that has more measured nodes there; a stretch that a branch or an aneurysm
/// leaves stays as it is. Directions of edges are stale afterwards. Returns the places of the joined
/// ends, one for each pair, mm, LPS.
std::vector<Eigen::Vector3d> joinOverlappingEnds(NodeGraph& graph);

}  // namespace lumen::convert
