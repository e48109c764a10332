// SPDX-License-Identifier: Apache-2.0
// Vertices and triangles in the coding of EXT_meshopt_compression. meshoptimizer's header stays
// behind this file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"

namespace lumen::convert {

/// Orders triangles so that vertices are reused soon, and vertices in the order in which triangles
/// use them.
void orderForDrawing(MeshPart& part);

struct MeshoptStream {
  std::vector<unsigned char> bytes;  ///< coded bytes
  bool isExponential = false;        ///< the bytes need the extension's filter EXPONENTIAL
};

/// A stream of vertices. Floats are rounded to multiples of 2^exponent, or coarser ones where 24
/// bits do not hold them, and `stream` receives the rounded values that a reader decodes.
MeshoptStream encodeVertices(VertexStream& stream);

/// Triangles of any number of parts; `count` is a multiple of three.
std::vector<unsigned char> encodeTriangles(std::span<const std::uint32_t> index,
                                           std::size_t vertices);

}  // namespace lumen::convert
