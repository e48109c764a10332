// SPDX-License-Identifier: Apache-2.0
// A surface cut into boxes, for programs that sample each mesh on a grid of fixed size.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// Cuts a surface by planes across its axes until every piece fits into `cells` cells of `share` of
/// its least radius, or until it is of `kFewest` triangles. Edges that a plane cuts are cut at the
/// same point on both sides. Planes avoid walls that run along them: beside such a wall a piece
/// would not hold the wall that is nearest. One piece if nothing needs cutting: the mesh itself. A
/// piece holds all of the surface in its box, so the side of its nearest triangle on which a point
/// of the box lies is the side of the surface on which it lies.
std::vector<SurfaceMesh> cutIntoPieces(const SurfaceMesh& mesh, std::size_t cells, double share);

}  // namespace lumen::convert
