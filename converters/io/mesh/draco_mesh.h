// SPDX-License-Identifier: Apache-2.0
// One part of a mesh as a Draco bit stream. Draco's headers stay behind this file.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// Vertices `first` .. `first + count` of streams, and the triangles between them.
struct DracoPart {
  std::span<const VertexStream> streams;  ///< POSITION first
  std::size_t first = 0, count = 0;
  std::span<const Triangle> triangle;  ///< indices from `first` on
};

/// The cube whose grid positions are rounded to. Parts with one cube keep their common vertices in
/// equal places.
struct DracoGrid {
  Float3 origin{};  ///< mm
  float range = 1;  ///< edge of the cube, mm
};

struct DracoMesh {
  std::vector<char> bytes;
  std::vector<int> id;  ///< Draco's unique ids of the streams
  std::size_t vertices = 0,
              triangles = 0;  ///< after decoding: Draco renumbers, and may split or drop some
  Float3 low{}, high{};       ///< box of the decoded positions, mm
};

/// Throws Error(Usage) for options out of range, and Error(Failed) if Draco refuses the mesh, which
/// needs at least one triangle.
DracoMesh encodeDraco(const DracoPart& part, const DracoGrid& grid,
                      const WriteMeshOptions& options);

}  // namespace lumen::convert
