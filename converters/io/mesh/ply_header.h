// SPDX-License-Identifier: Apache-2.0
// The head of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/mesh/mesh_builder.h"

namespace lumen::convert {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class PlyEncoding : std::uint8_t { Ascii, LittleEndian, BigEndian };

std::size_t sizeOf(PlyType type);
inline bool isWhole(PlyType type) {
  return type < PlyType::Float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Int8;
  bool isList = false;
  PlyType countType = PlyType::Uint8;  ///< type of a list's count; a whole number
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  /// The minimum size, bytes, of one such element in the file.
  [[nodiscard]] std::size_t leastBytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  StatedFrame frame;
  std::map<int, std::string> groups;  ///< names in comments, by number
  std::size_t bytes = 0;              ///< size of the header
  std::size_t lines = 0;
};

/// Refuses, with the line, a header that is not PLY, and counts that the bytes after it cannot
/// hold.
PlyHeader parsePlyHeader(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
