// SPDX-License-Identifier: Apache-2.0
// The optional encodings of chunks: zstd for any, Draco for positions of points.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "formats/case/case.h"
#include "formats/container/container.h"

namespace lumen::formats {

// Draco's bitstream for point sets, restricted to what this format allows.

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

/// One zstd frame (RFC 8878), or nothing if that is not smaller or expands too much to be legal.
std::optional<std::vector<std::byte>> compressZstd(std::span<const std::byte> bytes);

struct QuantisedPoints {
  std::vector<std::byte> encoded;  ///< a Draco point cloud in the points' order
  PointQuantisation quantisation;
  std::size_t count = 0;
  [[nodiscard]] std::vector<Vec3f> decoded() const;
};

/// Points rounded to 1 to 30 bits per coordinate of their bounding box; nothing without points, or
/// if the box is too large for a float.
std::optional<QuantisedPoints> quantise(std::span<const Vec3f> points, int bits);

/// The decoded bytes of a chunk, or nothing, with an issue. Allocates memory in proportion to the
/// chunk's raw size, which readContainer() has bounded by the stored one.
std::optional<std::vector<std::byte>> decodeChunk(const Chunk& chunk, IssueList& issues);

}  // namespace lumen::formats
