// SPDX-License-Identifier: Apache-2.0
// Improvement of triangles within a triangulated region of a plane.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/stages/surface/flat_region.h"

namespace lumen::convert {

/// Puts `points`, each within a triangle, into the mesh, flips edges until they are Delaunay's but
/// for those of the boundary (Lawson, 1977), and moves the new points to the middle of their
/// neighbours.
void addInnerPoints(FlatMesh& mesh, const std::vector<Eigen::Vector2d>& points);

/// Splits the edge between two points, if two triangles share it, in its middle.
void splitEdge(FlatMesh& mesh, std::uint32_t a, std::uint32_t b);

}  // namespace lumen::convert
