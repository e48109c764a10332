// SPDX-License-Identifier: Apache-2.0
// A finished surface as writers take it.
#pragma once

#include "converters/mesh/surface_mesh.h"
#include "converters/surface/case_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Positions as floats, normals from the triangles' (of the wall's where there are some), and what
/// the case says of each vertex. Throws Error(Unsupported) above 2^32 - 1 vertices.
SurfaceMesh surfaceMeshOf(const CaseSurface& surface, const formats::Case& source);

}  // namespace lumen::convert
