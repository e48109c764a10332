// SPDX-License-Identifier: Apache-2.0
// The surface of a case as targets put it into their files.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/progress.h"
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

// The inside of a surface as tetrahedra, by TetGen, which is run as a program if it is installed.

struct VolumeMesh {
  std::vector<std::array<double, 3>> position;  ///< those of the surface first, as they were
  std::vector<std::array<std::uint32_t, 4>>
      tetrahedron;                       ///< corners, of positive volume, as VTK orders them
  std::vector<std::uint32_t> region;     ///< one for each tetrahedron: 1, 2, ... by connected part
  std::vector<std::uint32_t> elementOf;  ///< one for each triangle of the surface: its tetrahedron
};

/// The mesh, or nothing and the reason in `why`, which names the field "edge". The surface is closed and keeps its triangles; its
/// lengths may be in any unit. Throws Error(Cancelled), and Error(Failed) if there is no room for
/// temporary files.
std::optional<VolumeMesh> volumeMesh(const SurfaceMesh& surface, const FieldWord& word,
                                     Progress& progress, std::string& why);

}  // namespace lumen::convert
