// SPDX-License-Identifier: Apache-2.0
// Triangle meshes into files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/mesh/branch_mesh.h"

namespace lumen::convert {

struct WriteMeshOptions {
  bool draco = false;          ///< glTF only: KHR_draco_mesh_compression
  int dracoPositionBits = 14;  ///< quantisation of a branch's bounding box, 1 .. 30
  int dracoNormalBits = 10;    ///< quantisation of a normal, 2 .. 30
};

/// Writes by `format`: "glb", "gltf" (with embedded buffers), "obj", "stl" (binary), "ply"
/// (binary), atomically. glTF is metres, +Y up, through the root node's matrix; the others stay in
/// mm, LPS.
void writeMesh(const std::vector<BranchMesh>& meshes, const std::filesystem::path& file,
               const std::string& format, const WriteMeshOptions& options);

}  // namespace lumen::convert
