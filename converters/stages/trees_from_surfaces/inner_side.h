// SPDX-License-Identifier: Apache-2.0
// The inner side of walls that have a thickness.
#pragma once

#include <cstddef>
#include <optional>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

namespace lumen::convert {

/// The inner side of a wall with a thickness whose inner and outer side are one surface: the
/// triangles that face, away from the wall, little but the wall. Oriented out of the lumen, with an
/// opening where the lumen is open; not repaired. Nothing if the surface is not that of such a
/// wall: if less than a quarter of its area faces so, or more than a wall's inner side can have.
/// `tree` is that of `surface`. Throws Error(Cancelled).
std::optional<TriangleMesh> innerSide(const ClosedMesh& surface, const TriangleTree& tree,
                                      const Progress& progress);

/// A mesh without the parts that another one encloses: debris and cavities. An enclosed part that
/// has at least a quarter of the area of the enclosing one is the inner side of a wall, and the
/// outer one is left out instead.
struct UnnestedMesh {
  TriangleMesh mesh;
  std::size_t enclosed = 0;  ///< parts that were left out because another one encloses them
  std::size_t outer = 0;     ///< parts that were left out because they are the outer side of a wall
};
/// The parts of `mesh` are oriented and manifold, closed or open at ends.
UnnestedMesh unnested(TriangleMesh mesh);

}  // namespace lumen::convert
