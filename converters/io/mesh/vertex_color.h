// SPDX-License-Identifier: Apache-2.0
// Vertex colours that show a value.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

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
/// logarithm of the radius; one of seven hues for a branch, repeated after every seventh. All
/// colours are distinguishable with any kind of colour vision.
std::vector<Color> vertexColors(const SurfaceMesh& surface, const ColorScale& scale);

/// The name of the colour scheme that vertexColors() applies.
const char* colorMapName(ColorBy by);

}  // namespace lumen::convert
