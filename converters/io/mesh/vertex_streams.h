// SPDX-License-Identifier: Apache-2.0
// Vertex data of a surface as glTF attributes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

// Vertex colours that show a value.

/// The colours stand for numbers of a range.
constexpr bool hasRange(ColorBy by) {
  return by == ColorBy::Radius || by == ColorBy::Confidence;
}

/// Red, green, blue and opacity in linear light; 65535 stands for 1.
using Color = std::array<std::uint16_t, 4>;

/// Mapping from values to colours.
struct ColorScale {
  ColorBy by = ColorBy::None;
  float low = 0, high = 0;  ///< values with the first and the last colour; radii in mm
};

/// The range of the values of a surface: its least and its greatest radius, or 0 to 1 for
/// confidence. Throws Error(InvalidInput) if there are no such values.
ColorScale measureColorScale(const SurfaceMesh& surface, ColorBy by);

/// The colour of each vertex: viridis, from dark blue to yellow, for confidence, and for the
/// logarithm of the radius; one of seven hues for a branch, repeated after every seventh; one for
/// each system of vessels. All colours are distinguishable with any kind of colour vision.
std::vector<Color> vertexColors(const SurfaceMesh& surface, const ColorScale& scale);

/// The colour that stands for a system of vessels everywhere: red, green and blue of sRGB, 0 to 1.
std::array<double, 3> systemColor(formats::VesselSystem system);
/// The same as "#RRGGBB".
std::string systemColorHex(formats::VesselSystem system);

/// The name of the colour scheme that vertexColors() applies.
const char* colorMapName(ColorBy by);

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
