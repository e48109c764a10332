// SPDX-License-Identifier: Apache-2.0
// Draco's bitstream for point sets, restricted to what this format allows.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "formats/case/case.h"

namespace lumen::formats {

/// Origin of quantised coordinates, and length that the greatest of them stands for, mm.
struct QuantisationBox {
  Vec3f origin;
  float range = 1;  ///< the longest edge of the points' bounding box; > 0
};

/// The box of finite points; nothing if they are too far apart for a float.
std::optional<QuantisationBox> quantisationBox(std::span<const Vec3f> points);

/// A point cloud in the points' order; 1 to 30 bits per coordinate.
std::vector<std::byte> encodeDraco(std::span<const Vec3f> points, const QuantisationBox& box,
                                   int bits);

/// The positions of a Draco 2.x point cloud, sequentially encoded, with one quantised attribute of
/// three f32; nothing for any other. `rawSize` is 12 bytes per point.
std::optional<std::vector<std::byte>> decodeDraco(std::span<const std::byte> bytes,
                                                  std::size_t rawSize);

}  // namespace lumen::formats
