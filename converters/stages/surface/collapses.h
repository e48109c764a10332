// SPDX-License-Identifier: Apache-2.0
// Collapsing the edges of a surface, the cheapest first.
#pragma once

#include <cstddef>

#include "converters/base/progress.h"
#include "converters/stages/surface/remesh_mesh.h"

namespace lumen::convert {

struct CollapseBounds {
  double maxError = 0;        ///< mm, in both directions, from the mesh as given; 0: no bound
  std::size_t triangles = 0;  ///< ends at this number
};

/// Collapses edges of a mesh without boundary, each onto one of its ends, in the order of the root
/// mean square distance of the vertex that stays from the planes of the faces that were merged into
/// it: in mm, or in targets where there is no bound. No collapse breaks the rules of RemeshMesh,
/// makes a face sharper than 15 degrees that was not, or makes one that runs through another; with
/// a bound, none moves the surface farther away than this. Targets are the lengths of edges. Throws
/// Error(Cancelled).
void collapseCheapest(RemeshMesh& mesh, const CollapseBounds& bounds, const Progress& progress);

}  // namespace lumen::convert
