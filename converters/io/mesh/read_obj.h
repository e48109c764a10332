// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ ("Advanced Visualizer Manual", appendix B1, 1992).
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The faces of an OBJ file as triangles, polygons as fans. Indices may be negative. A group (g) or
/// else an object (o) of triangles is a group with its name. Lines, points, materials, normals and
/// texture are ignored; curved surfaces are too, with a note.
MeshFile parseObj(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
