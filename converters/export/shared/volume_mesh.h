// SPDX-License-Identifier: Apache-2.0
// The inside of a surface as tetrahedra, by TetGen, which is run as a program if it is installed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

struct VolumeMesh {
  std::vector<std::array<double, 3>> position;  ///< those of the surface first, as they were
  std::vector<std::array<std::uint32_t, 4>>
      tetrahedron;                       ///< corners, of positive volume, as VTK orders them
  std::vector<std::uint32_t> region;     ///< one for each tetrahedron: 1, 2, ... by connected part
  std::vector<std::uint32_t> elementOf;  ///< one for each triangle of the surface: its tetrahedron
};

/// The mesh, or nothing and the reason in `why`. The surface is closed and keeps its triangles; its
/// lengths may be in any unit. Throws Error(Cancelled), and Error(Failed) if there is no room for
/// temporary files.
std::optional<VolumeMesh> volumeMesh(const SurfaceMesh& surface, Progress& progress,
                                     std::string& why);

}  // namespace lumen::convert
