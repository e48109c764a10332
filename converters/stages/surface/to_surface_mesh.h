// SPDX-License-Identifier: Apache-2.0
// The surface of a case in the form for writers of meshes.
#pragma once

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// A surface as a mesh for writers: its vertices, triangles and groups, the labels of the case that
/// `field` is of, and at each vertex the radius and the inlier rate of its place along the vessel.
/// Normals are those of the field, outward; vertices within a flat end have the end's. Throws
/// Error(Cancelled).
SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SheetField& field, Progress& progress);

}  // namespace lumen::convert
