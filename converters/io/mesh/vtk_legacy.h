// SPDX-License-Identifier: Apache-2.0
// VTK's legacy format: keywords as text, numbers as text or big-endian behind a line.
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen::convert {

/// A legacy file of PolyData, versions 1 to 5.1; of its cell data the array `wanted`, of its point
/// data none. `frame` gets what its title says. Throws Error(InvalidInput) with the line or byte,
/// what was found and what was expected, and Error(Unsupported) for other data sets.
VtkPolyData parseVtkLegacy(std::string_view bytes, const std::string& name, std::string_view wanted,
                           StatedFrame& frame);

}  // namespace lumen::convert
