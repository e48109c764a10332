// SPDX-License-Identifier: Apache-2.0
// Parts that the fuzz targets of meshes share.
#pragma once

#include <cstddef>
#include <cstdint>

#include "converters/io/mesh/read_mesh.h"

namespace lumen::fuzz {

/// Reads the bytes as a mesh; what is read must be what MeshFile promises, and its repair what
/// RepairResult promises.
void checkMesh(const std::uint8_t* data, std::size_t size, convert::MeshFormat format);

}  // namespace lumen::fuzz
