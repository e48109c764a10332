// SPDX-License-Identifier: Apache-2.0
// Tetrahedra in a closed surface, by Netgen.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/field_word.h"
#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

struct Tetrahedra {
  std::vector<Eigen::Vector3d> added;  ///< new points, whose numbers follow those of the surface
  std::vector<std::array<std::uint32_t, 4>> cell;  ///< of positive volume, as VTK orders them
};

/// The inside of closed, oriented surfaces that do not cross as tetrahedra that keep the surfaces' vertices and
/// triangles. The program lumen-netgen, which lies beside this program or in PATH, is run for each connected
/// surface, as Netgen can neither be cancelled nor leave the working folder alone. Equal surfaces give
/// equal tetrahedra. Throws Error(Unsupported) if it is not installed, Error(Failed) if it cannot fill a surface,
/// and Error(Cancelled).
Tetrahedra fillTetrahedra(const TriangleMesh& surface, const FieldWord& word, Progress& progress);

}  // namespace lumen::convert
