// SPDX-License-Identifier: Apache-2.0
// Places at which two vessels only touch, found from the loops that they close (docs/method.md,
// section 1.14).
#pragma once

#include "converters/stages/editing/node_graph.h"

namespace lumen::convert {

/// Cuts loops of a graph where two vessels touch instead of at the links that hold them together. A
/// *rung* is a way between two nodes along which two lumens meet, and at both of which another vessel
/// goes on: the vessels pass one another there. A link on a loop that has a rung becomes an edge, and
/// the rung is cut; other links stay, as those of communicating arteries. Directions of edges are stale
/// afterwards.
void cutRungs(NodeGraph& graph);

}  // namespace lumen::convert
