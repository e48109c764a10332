// SPDX-License-Identifier: Apache-2.0
// VTK's legacy format: keywords as text, numbers as text or big-endian after a line.
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_builder.h"
#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen::convert {

/// A legacy file of PolyData, versions 1 to 5.1; only the array `wanted` of its cell data is kept,
/// and no point data. `frame` receives the frame stated in the title. Throws Error(InvalidInput)
/// with the line or byte, the finding and the expectation, and Error(Unsupported) for other data
/// sets.
VtkPolyData parseVtkLegacy(std::string_view bytes, const std::string& name, std::string_view wanted,
                           StatedFrame& frame);

}  // namespace lumen::convert
