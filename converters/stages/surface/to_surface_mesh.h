// SPDX-License-Identifier: Apache-2.0
// The surface of a case as writers of meshes take it.
#pragma once

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// The same vertices, triangles and groups, with the labels of the case that `field` is of, and at
/// each vertex the radius and the inlier rate of its place along the vessel. Normals are those of
/// the field, outward; of vertices within a flat end that of the end. Throws Error(Cancelled).
SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SheetField& field, Progress& progress);

}  // namespace lumen::convert
