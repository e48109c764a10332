// SPDX-License-Identifier: Apache-2.0
// Edge collapses on arrays: the inner loop of simplification.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"

namespace lumen::convert {

struct CollapseRules {
  /// Greatest distance of each vertex of the given surface from the result, mm; empty: any.
  std::vector<double> allowed;
  std::size_t triangles = 0;     ///< ends at this number
  std::vector<float> closeFrom;  ///< closeVertices(); empty: all vertices are near other sheets
};

/// Removes vertices of a closed surface, each by a collapse of an edge onto its other end, in the
/// order of the distance of that end from the planes of the triangles that were merged into both (M.
/// Garland, P. Heckbert, *Surface simplification using quadric error metrics*, 1997), and as shares
/// of the edges' lengths if `allowed` is empty, so that thin vessels lose no more than wide ones.
/// Vertices that stay do not move. No vertex that went lies farther from the triangles that took its
/// place than `allowed` for it. Topology and groups are kept, at least eight edges of a rim are, and
/// no triangle turns by more than 60 degrees from the surface's normals at its corners, or becomes
/// sharper than 5 degrees, unless one that it replaces did; if `triangles` cannot be reached so, than 1
/// and 80 degrees. With `allowed`, vertices go first that stay within a quarter of it. No triangle comes
/// to pass through another one where both are near a vertex that is as close to another sheet as the
/// share of `allowed` that counts then. Returns for each triangle whether it is near one. Deterministic. Throws Error(Cancelled).
std::vector<std::uint8_t> collapseEdges(CaseSurface& surface, const CollapseRules& rules,
                                        const Progress& progress);

}  // namespace lumen::convert
