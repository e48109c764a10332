// SPDX-License-Identifier: Apache-2.0
// Vertices and triangles as EXT_meshopt_compression codes them. meshoptimizer's header stays behind
// this file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"

namespace lumen::convert {

/// Orders triangles so that vertices are used again soon, and vertices as triangles use them.
void orderForDrawing(MeshPart& part);

struct MeshoptStream {
  std::vector<unsigned char> bytes;  ///< coded
  bool isExponential = false;        ///< they pass through the extension's filter of that name
};

/// A stream of vertices. Floats are rounded to multiples of 2^exponent, or coarser ones where 24
/// bits do not hold them, and `stream` is changed to what a reader will get.
MeshoptStream encodeVertices(VertexStream& stream);

/// Triangles of any number of parts; `count` is a multiple of three.
std::vector<unsigned char> encodeTriangles(std::span<const std::uint32_t> index,
                                           std::size_t vertices);

}  // namespace lumen::convert
