// SPDX-License-Identifier: Apache-2.0
// The cell size of the polygonisation of a case, and its limits.
#pragma once

#include <cstddef>

#include "formats/case/case.h"

namespace lumen::convert {

/// Bounds on the lattice that keep positions within int and a node's grid within memory.
constexpr double kMaxPosition = 1e8, kMaxAcross = 1e4;
constexpr std::size_t kMaxSamples = std::size_t{1} << 27;

/// Edge of a cell, mm, at a node of that radius: the case's, or a half, a quarter or an eighth of
/// it, so that the node is two cells wide.
double cellForRadius(double cell, double radius);

/// The greatest cell that leaves a node of that radius two cells wide, mm.
double coarsestCellFor(double radius);

/// Checks the lattice of `cell` mm. Throws Error(InvalidInput), with a cell that is large enough,
/// if it needs more samples at one node, or more triangles in all, than fit into memory. Reads the
/// tree only, so it takes no time.
void checkCell(const formats::Case& source, double cell);

}  // namespace lumen::convert
