// SPDX-License-Identifier: Apache-2.0
// The inside of the vessels of a case as cells, as targets put them into their files.
#pragma once

#include <string>

#include "converters/export/shared/target.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/volume_mesh/make_volume_mesh.h"

namespace lumen::convert {

/// The cells within a surface of the case that was made with that gap; both in mm, LPS. Positions of the cells
/// are in the target's frame, the report is in mm. Throws as makeVolumeMesh().
MadeVolumeMesh cellsWithin(const ExportInput& input, const SurfaceMesh& surface, double gap);

/// The number of cells and their least quality, for a sentence.
std::string cellsSentence(const VolumeMeshReport& report);

}  // namespace lumen::convert
