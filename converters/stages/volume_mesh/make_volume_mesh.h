// SPDX-License-Identifier: Apache-2.0
// The inside of a closed surface as prisms at the wall and tetrahedra within.
#pragma once

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/volume_mesh.h"
#include "converters/stages/volume_mesh/volume_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct MadeVolumeMesh {
  VolumeMesh mesh;
  VolumeMeshReport report;
};

/// The cells within a surface that closedSurface() made of `source` with that gap, mm: layers of
/// prisms on all but flat ends, and tetrahedra. The boundary is the surface, but that flat ends are
/// cut into other triangles if there are layers. Each cell has a positive volume and quality, each face is
/// shared by two cells or is part of the boundary, and the volumes add up to that of the
/// surface; that is checked. Throws as wallLayers() and fillTetrahedra(), and Error(Failed) if a check
/// fails.
MadeVolumeMesh makeVolumeMesh(const formats::Case& source, const SurfaceMesh& surface, double gap,
                              const VolumeMeshOptions& options, Progress& progress);

}  // namespace lumen::convert
