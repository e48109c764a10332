// SPDX-License-Identifier: Apache-2.0
// Fewer triangles, with what that costs.
#pragma once

#include <cstddef>

#include "converters/common/progress.h"
#include "converters/surface/case_surface.h"
#include "converters/surface/sheet_field.h"
#include "converters/surface/surface_error.h"

namespace lumen::convert {

/// When decimation ends: at whichever comes first.
struct DecimateOptions {
  double maxError = 0;        ///< mm, from the field; 0: no bound
  std::size_t triangles = 0;  ///< as few as this
};

/// Collapses edges by M. Garland and P. Heckbert, Surface simplification using quadric error
/// metrics, 1997, with OpenMesh's decimater; then halves edges again, and moves the new vertices
/// onto the field, wherever the mesh is farther from it than `maxError`. Topology, groups and the
/// planes of ends are kept; at least eight edges are left of a rim. Gives the measured error: above
/// `maxError` only where the input was. Throws Error(Cancelled).
SurfaceError decimate(CaseSurface& surface, const SheetField& field, const DecimateOptions& options,
                      Progress& progress);

}  // namespace lumen::convert
