// SPDX-License-Identifier: Apache-2.0
// Self-intersections of a triangle mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

// Intersection test of two triangles of a mesh.

/// True if the triangle's vertices do not lie on one line.
bool hasArea(const TriangleMesh& mesh, const Triangle& triangle);

/// True if two triangles with area have more in common than the vertices or the edge that they
/// share by index. Exact.
bool intersect(const TriangleMesh& mesh, const Triangle& one, const Triangle& other);

struct SelfIntersections {
  /// Pairs of triangles that intersect, the smaller index first.
  std::vector<std::array<std::uint32_t, 2>> pairs;
  bool isComplete = true;  ///< false if there are more pairs than the limit
};

/// All pairs of triangles that have more in common than the vertices or the edge that they share by
/// index: triangles that cross, touch, overlap in a plane, are folded onto one another, or have the
/// same three vertices. Exact for the given doubles. Triangles without area are left out, and so
/// are those with positions that are not finite or beyond the range of orientation(). At most
/// `limit` pairs, deterministic, in a fixed order. Throws Error(Cancelled) if `progress`, which may
/// be null, is cancelled.
SelfIntersections selfIntersections(const TriangleMesh& mesh, std::size_t limit = 1'000'000,
                                    const Progress* progress = nullptr);

}  // namespace lumen::convert
