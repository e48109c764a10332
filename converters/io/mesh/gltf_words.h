// SPDX-License-Identifier: Apache-2.0
// Words of glTF 2.0 that reading and writing share.
#pragma once

#include <cstdint>

namespace lumen::convert {

/// The first word of a GLB, and the types of its chunks: "glTF", "JSON", "BIN" and 0.
inline constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a,
                               kBinaryChunk = 0x004e4942;

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

}  // namespace lumen::convert
