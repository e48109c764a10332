// SPDX-License-Identifier: Apache-2.0
// The surface of a case as targets put it into their files.
#pragma once

#include <optional>
#include <vector>

#include "converters/export/shared/target.h"
#include "converters/geometry/box.h"
#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

struct ExportedSurface {
  SurfaceMesh mesh;                  ///< in the target's frame, closed
  std::vector<SurfaceMesh> coarser;  ///< levels of detail behind it, where the options ask for some
  std::vector<NamedEnd> ends;        ///< mm, LPS
  SurfaceReport report;
};

/// The lumen's surface, with the options of the input. Vessels that touch are drawn apart by `gap`
/// mm, if it is stated, else by the gap of closedSurface(). Throws as closedSurface().
ExportedSurface lumenSurface(const ExportInput& input, std::optional<double> gap = {});

/// A wall around it as a solid, of the thickness in the options, or, without one, of `usual`.
/// Vessels that touch or overlap share it. Throws as closedSurface().
ExportedSurface wallSurface(const ExportInput& input, const Length& usual);

/// The box of all vertices.
Box3d boundingBox(const SurfaceMesh& mesh);

}  // namespace lumen::convert
