// SPDX-License-Identifier: Apache-2.0
// Vertex data of a surface as glTF attributes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/vertex_color.h"

namespace lumen::convert {

/// Numbers of glTF's component types.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;

/// One attribute of all vertices of a list of parts, one part after another.
struct VertexStream {
  std::string name;            ///< POSITION, NORMAL, COLOR_0, _RADIUS, ...
  int componentType = kFloat;  ///< or kUnsignedShort
  std::size_t components = 1;  ///< 1, 3 or 4
  bool isNormalized = false;   ///< 65535 means 1
  std::size_t stride = 4;      ///< bytes per vertex: a multiple of four, the rest zero
  int exponent = 0;            ///< floats may be rounded to multiples of 2^exponent
  std::vector<unsigned char> bytes{};
};

/// POSITION (mm, LPS), NORMAL, _RADIUS (mm), _BRANCH (index of the label; none if there are over
/// 65536 branches, as glTF has no attribute of larger integers), _CONFIDENCE if it is known, and
/// COLOR_0 if `scale` asks for it.
std::vector<VertexStream> vertexStreams(const SurfaceMesh& surface, std::span<const MeshPart> parts,
                                        const ColorScale& scale);

}  // namespace lumen::convert
