// SPDX-License-Identifier: Apache-2.0
// Meshes as the bytes of a glTF file. Equal meshes give equal bytes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "converters/mesh/branch_mesh.h"
#include "converters/mesh/write_options.h"

namespace lumen::convert {

/// LPS millimetres to glTF metres, column-major: x = left, y = superior (up), z = anterior. A
/// rotation and a scale; nothing is mirrored.
constexpr std::array<double, 16> kGltfFromLps = {0.001, 0,     0,      0,  //
                                                 0,     0,     -0.001, 0,  //
                                                 0,     0.001, 0,      0,  //
                                                 0,     0,     0,      1};

/// glTF 2.0: one mesh and one node per branch that has triangles, named by its label, in LPS
/// millimetres below a root node whose matrix is kGltfFromLps. GLB if `binary`, otherwise JSON with
/// its buffer in a data URI. Throws Error(Unsupported) above 2 GiB of vertex data, and
/// Error(Failed) if Draco refuses a mesh.
std::string encodeGltf(const std::vector<BranchMesh>& meshes, bool binary,
                       const WriteMeshOptions& options);

}  // namespace lumen::convert
