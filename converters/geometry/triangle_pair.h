// SPDX-License-Identifier: Apache-2.0
// Intersection test of two triangles of a mesh.
#pragma once

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// True if the triangle's vertices do not lie on one line.
bool hasArea(const TriangleMesh& mesh, const Triangle& triangle);

/// True if two triangles with area have more in common than the vertices or the edge that they
/// share by index. Exact.
bool intersect(const TriangleMesh& mesh, const Triangle& one, const Triangle& other);

}  // namespace lumen::convert
