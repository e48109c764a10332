// SPDX-License-Identifier: Apache-2.0
// The table of neighbours that a cursor's steps and blending read.
#pragma once

#include <vector>

#include "formats/field/neighbourhood.h"
#include "model.h"

namespace lumen::blob {

/// Appends blocks with the neighbours of all nodes, and stores their place in each node's record.
/// `spacing`: see field::measureSpacings(), mm^2.
void addNeighbours(const field::TreeView& tree, const field::Neighbourhood& around,
                   const std::vector<double>& spacing, std::vector<NodeRecord>& nodes,
                   std::vector<NeighbourBlock>& blocks);

}  // namespace lumen::blob
