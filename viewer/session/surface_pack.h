// SPDX-License-Identifier: Apache-2.0
// Triangles as the page shows them.
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"
#include "converters/io/mesh/mesh_skin.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/closed_surface.h"

namespace lumen::viewer {

/// The place of a surface among those of its case.
struct SurfaceLevel {
  std::string_view kind;  ///< "quick" or "closed"
  int level = 0;          ///< 0: the finest
  int levels = 1;         ///< number of levels in the end
};

/// The pack `surface` of a case's surface, its triangles sorted by group and branch. `skin`: the
/// bones of this surface alone, or null where it does not move.
std::string surfacePack(const convert::SurfaceMesh& surface, const SurfaceLevel& level,
                        const convert::SurfaceReport& report,
                        const convert::MeshSkin* skin = nullptr);

/// The pack `surface` of a mesh that was opened, in mm.
std::string meshPack(const convert::MeshFile& mesh);

/// The mesh in mm; a file without a unit is in mm.
convert::MeshFile inMillimetres(convert::MeshFile mesh);

}  // namespace lumen::viewer
