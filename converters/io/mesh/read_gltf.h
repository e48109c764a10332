// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (Khronos), GLB or text.
#pragma once

#include <filesystem>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The triangles of the file's scene in mm, LPS: placed by their nodes, taken from glTF's metres
/// with +Y up. What lumen wrote comes back exactly. Primitives are groups, of the name in their
/// extras as lumen writes it, or else of their mesh. KHR_draco_mesh_compression and
/// KHR_mesh_quantization are read; materials, skins and animations are passed over.
MeshFile parseGltf(std::string_view bytes, const std::filesystem::path& file);

}  // namespace lumen::convert
