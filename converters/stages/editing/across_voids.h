// SPDX-License-Identifier: Apache-2.0
// Vessels that go on behind a stretch without contrast (docs/method.md, section 1.14).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {

/// Joins trees of a graph by bridges where an end of one lies ahead of an end of another, faces it and
/// is as wide, although no lumen is seen between them: blood that swirls or flows along the slices
/// leaves such voids in magnetic resonance, a clip or a stent beside a vessel in other volumes. Both
/// trees must be longer than the gap. Directions of edges are stale afterwards. Returns the places of
/// the joined ends, one for each pair, mm.
std::vector<Eigen::Vector3d> joinAcrossVoids(NodeGraph& graph);

}  // namespace lumen::convert
