// SPDX-License-Identifier: Apache-2.0
// How far a mesh is from the surface that it stands for.
#pragma once

#include "converters/surface/case_surface.h"
#include "converters/surface/sheet_field.h"

namespace lumen::convert {

/// How far a mesh and the surface of the field are from each other, mm, at the vertices and at the
/// middles of edges and triangles of all groups but flat ends.
struct SurfaceError {
  double largest = 0;
  double rms = 0;  ///< of the triangles' middles, each by its area
};

/// The distance of the mesh from the field: as points of the mesh cover it, and the feet of these
/// points the field's surface, it is the distance both ways.
SurfaceError surfaceError(const CaseSurface& surface, const SheetField& field);

/// The distance of a point from the field's surface, mm, for a cursor that begins at `node`.
double distanceToField(const SheetField& field, const Eigen::Vector3d& point, std::uint32_t node);

}  // namespace lumen::convert
