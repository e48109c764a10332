// SPDX-License-Identifier: Apache-2.0
// Cells as a polyMesh of OpenFOAM.
#pragma once

#include <vector>

#include "converters/export/shared/target.h"
#include "converters/export/targets/openfoam/foam_patches.h"
#include "converters/io/mesh/volume_mesh.h"

namespace lumen::convert {

/// The five files of constant/polyMesh, as text: points, faces, owner, neighbour, boundary. `patches` has the
/// groups of the mesh that have faces, in their order. Positions are written as they are, in m.
std::vector<ExportFile> polyMesh(const VolumeMesh& mesh, const std::vector<FoamPatch>& patches);

}  // namespace lumen::convert
