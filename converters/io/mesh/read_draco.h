// SPDX-License-Identifier: Apache-2.0
// Decoder of one mesh from a Draco bit stream. Draco's headers stay behind this file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

struct DecodedDraco {
  std::vector<std::array<float, 3>> position;
  std::vector<Triangle> triangle;  ///< indices, unchecked
};

/// Decodes `bytes` into `points` and `triangles`, in a process of its own, because Draco allocates
/// the sizes that a stream announces; the attribute whose unique id is `position` holds the points.
/// Empty if the stream is damaged, holds other counts, or more than 64 points and triangles per
/// byte, a density that no coded surface reaches.
DecodedDraco decodeDracoMesh(std::string_view bytes, std::uint32_t position, std::size_t points,
                             std::size_t triangles);

}  // namespace lumen::convert
