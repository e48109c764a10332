// SPDX-License-Identifier: Apache-2.0
// One mesh as a Draco bit stream. Draco's headers stay behind this file.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/mesh/branch_mesh.h"
#include "converters/mesh/write_options.h"

namespace lumen::convert {

struct DracoMesh {
  std::vector<char> bytes;
  int positionId = 0, normalId = 0;  ///< Draco's unique ids of the attributes
  std::size_t vertices = 0,
              triangles = 0;  ///< as they decode: Draco renumbers, and may split or drop some
  Float3 low{}, high{};       ///< box of the decoded positions, mm
};

/// Throws Error(Usage) for options out of range, and Error(Failed) if Draco refuses the mesh, which
/// needs at least one triangle.
DracoMesh encodeDraco(const BranchMesh& mesh, const WriteMeshOptions& options);

}  // namespace lumen::convert
