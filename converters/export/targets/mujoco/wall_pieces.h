// SPDX-License-Identifier: Apache-2.0
// A surface cut into boxes, for programs that sample each mesh on a grid of fixed size.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// A corner of a triangle, and the vessel's radius there, in the unit of the surface.
struct WallCorner {
  Eigen::Vector3d position;
  double radius = 0;
};
using WallFacet = std::array<WallCorner, 3>;

/// The triangles of a surface with their corners.
std::vector<WallFacet> wallFacets(const SurfaceMesh& mesh);

/// Whether a piece may stay as it is for another reason than its size.
using PieceRule = std::function<bool(std::span<const WallFacet>)>;

/// Cuts a surface by planes across its axes until every piece fits into `cells` cells of `share` of
/// its least radius, or until it is of `kFewest` triangles; a
/// `rule`, if there is one, has to hold as well. Edges that a plane cuts are cut at the
/// same point on both sides. Planes avoid walls that run along them: beside such a wall a piece
/// would not hold the wall that is nearest. One piece if nothing needs cutting: the mesh itself. A
/// piece holds all of the surface in its box, so the side of its nearest triangle on which a point
/// of the box lies is the side of the surface on which it lies.
std::vector<SurfaceMesh> cutIntoPieces(const SurfaceMesh& mesh, std::size_t cells, double share,
                                       const PieceRule& rule = {});

}  // namespace lumen::convert
