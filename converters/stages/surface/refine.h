// SPDX-License-Identifier: Apache-2.0
// Remeshing that does not make a surface pass through itself.
#pragma once

#include <cstddef>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/remesh_target.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// Remaining faults after refine().
struct RefineReport {
  std::size_t offField = 0, sharp = 0;  ///< see RemeshReport
  std::size_t crossings = 0;            ///< pairs of triangles that pass through each other
};

/// Remeshes a surface that does not intersect itself (remesh.h) and mends crossings
/// (mend_crossings.h). Where some are left, the surface stays as it was given within a radius of
/// them, and all else is remeshed again; then within two, four and eight radii. Throws
/// Error(Cancelled).
RefineReport refine(CaseSurface& surface, const SheetField& field, const EdgeLength& edge,
                    Progress& progress);

}  // namespace lumen::convert
