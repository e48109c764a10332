// SPDX-License-Identifier: Apache-2.0
// Triangles for a region of a plane.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// Height of a row of equilateral triangles, in edges.
inline constexpr double kRowHeight = 0.866;

using Loop2 = std::vector<Eigen::Vector2d>;

/// Triangles of a plane, counter-clockwise.
struct FlatMesh {
  std::vector<Eigen::Vector2d>
      point;  ///< those of the loops, one loop after the other; then new ones
  std::vector<Triangle> triangle;
};

/// True if a loop of at least three points nowhere touches or crosses itself.
bool isSimple(const Loop2& loop);

/// The area that a loop encloses, negative if it runs clockwise.
double signedArea(const Loop2& loop);

/// True if `inner` lies within `outer` and touches it nowhere; both are simple.
bool isWithin(const Loop2& inner, const Loop2& outer);

/// Triangles of the region within the simple loop `outer`, which runs counter-clockwise, and
/// outside of the simple loops `holes` within it, which run clockwise. Edges are about `edge` long
/// where the loops do not force others: ears are clipped, points of a triangular lattice are put
/// in, and edges flipped until they are Delaunay's but for the loops' own. Nothing for loops
/// without these properties.
FlatMesh triangulateRegion(const Loop2& outer, const std::vector<Loop2>& holes, double edge);

// Improvement of triangles within a triangulated region of a plane.

/// Puts `points`, each within a triangle, into the mesh, flips edges until they are Delaunay's but
/// for those of the boundary (Lawson, 1977), and moves the new points to the middle of their
/// neighbours.
void addInnerPoints(FlatMesh& mesh, const std::vector<Eigen::Vector2d>& points);

/// Splits the edge between two points, if two triangles share it, in its middle.
void splitEdge(FlatMesh& mesh, std::uint32_t a, std::uint32_t b);

}  // namespace lumen::convert
