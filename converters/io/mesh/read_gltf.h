// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (Khronos), GLB or text.
#pragma once

#include <filesystem>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The triangles of the file's scene in mm, LPS: placed by their nodes, converted from glTF's
/// metres with +Y up. Files of lumen are restored exactly. Primitives are groups, named by their
/// extras as lumen writes them, or else by their mesh. KHR_draco_mesh_compression and
/// KHR_mesh_quantization are read; materials, skins and animations are ignored.
MeshFile parseGltf(std::string_view bytes, const std::filesystem::path& file);

}  // namespace lumen::convert
