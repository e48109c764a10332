// SPDX-License-Identifier: Apache-2.0
// Colours of vertices that show a value.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"

namespace lumen::convert {

/// Red, green, blue and opacity, of linear light, 65535 being 1.
using Color = std::array<std::uint16_t, 4>;

/// How colours are made from values.
struct ColorScale {
  ColorBy by = ColorBy::None;
  float low = 0, high = 0;  ///< values with the first and the last colour; of radii in mm
};

/// The range of the values of a surface: its least and its greatest radius, or 0 to 1 for
/// confidence. Throws Error(InvalidInput) if there are no such values.
ColorScale scaleOf(const SurfaceMesh& surface, ColorBy by);

/// The colour of each vertex: viridis, from dark blue to yellow, for confidence, and for radius by
/// its logarithm; one of seven hues for a branch, the same again for the seventh after it. All can be told apart with any
/// kind of colour vision.
std::vector<Color> colorsOf(const SurfaceMesh& surface, const ColorScale& scale);

/// The name of the colours that colorsOf() takes.
const char* colorMapName(ColorBy by);

}  // namespace lumen::convert
