// SPDX-License-Identifier: Apache-2.0
// Which nodes a cursor may step to, and which models blend.
#pragma once

#include <cstdint>
#include <vector>

#include "blob.h"

namespace lumen::blob {

/// Adjacency of all nodes in CSR form, symmetric, ascending within a node.
struct Neighbourhood {
  std::vector<std::uint32_t> offset, node;
  std::vector<bool> isEdge;  ///< per entry of `node`: a parent, child or link
};

/// Parents, children and links only. Indices are in range.
Neighbourhood edgesOf(const blob_model_def& def);

/// The edges; nodes two edges apart; nodes a few edges apart with only nodes between whose cells do
/// not part them (too thin for their wide neighbours); and nodes of different arms of a bifurcation
/// that are a short way apart along the tree and whose balls overlap well: there, both vessels are
/// one lumen.
Neighbourhood neighbourhoodOf(const blob_model_def& def, const Neighbourhood& edges);

}  // namespace lumen::blob
