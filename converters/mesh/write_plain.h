// SPDX-License-Identifier: Apache-2.0
// Meshes as the bytes of OBJ, STL and PLY files, in mm, LPS. Equal meshes give equal bytes.
#pragma once

#include <string>
#include <vector>

#include "converters/mesh/branch_mesh.h"

namespace lumen::convert {

/// Wavefront OBJ: one object per branch that has triangles; white space and control characters in
/// its label become "_", and a label that is then taken gets a number.
std::string encodeObj(const std::vector<BranchMesh>& meshes);

/// Binary STL: every branch in one solid.
std::string encodeStl(const std::vector<BranchMesh>& meshes);

/// Binary little-endian PLY: every branch in one mesh, with normals, and each face's branch by its
/// number.
std::string encodePly(const std::vector<BranchMesh>& meshes);

}  // namespace lumen::convert
