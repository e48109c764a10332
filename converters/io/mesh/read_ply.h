// SPDX-License-Identifier: Apache-2.0
// PLY (Turk, "The PLY polygon file format", 1994).
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The faces of a PLY file as triangles, polygons as fans: ASCII, or binary of either byte order,
/// with any properties and elements besides x, y, z and vertex_indices (or vertex_index).
MeshFile parsePly(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
