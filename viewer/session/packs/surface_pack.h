// SPDX-License-Identifier: Apache-2.0
// Triangles as the page shows them, and fewer of them while the scene moves.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/mesh/read_mesh.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"
#include "converters/stages/surface/closing/closed_surface.h"

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

/// A run of triangles.
struct TriangleRun {
  std::size_t first = 0, count = 0;
};

/// Triangles between the same vertices, run by run.
struct MovingSurface {
  std::vector<convert::Triangle> triangle;
  std::vector<TriangleRun> run;  ///< one for each run of the surface
};

/// Each run of `triangle` with a share of its triangles, so that all have about `most`, but no wall
/// moved by more than a third of its radius. `radius` is that of each vertex, mm. A run is never
/// empty if it was not.
MovingSurface movingSurface(std::span<const convert::Float3> position,
                            std::span<const float> radius,
                            std::span<const convert::Triangle> triangle,
                            std::span<const TriangleRun> run, std::size_t most);

}  // namespace lumen::viewer
