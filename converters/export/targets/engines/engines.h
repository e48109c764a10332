// SPDX-License-Identifier: Apache-2.0
// A case as one GLB for an engine of games or pictures, with the names of nodes that it looks at.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// vessels.glb: a thick wall; a node for each named end, its z axis out of the vessel. Throws as
/// wallSurface() and encodeGlbScene().
ExportResult exportGodot(const ExportInput& input);    ///< -col: a collider of its triangles
ExportResult exportUnity(const ExportInput& input);    ///< _LOD0, _LOD1, _LOD2, and MSFT_lod
ExportResult exportUnreal(const ExportInput& input);   ///< MSFT_lod
ExportResult exportBlender(const ExportInput& input);  ///< one mesh

TargetRow godotRow();
TargetRow unityRow();
TargetRow unrealRow();
TargetRow blenderRow();

}  // namespace lumen::convert
