// SPDX-License-Identifier: Apache-2.0
// VTK's legacy format: keywords as text, numbers as text or big-endian after a line.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen::convert {

/// A legacy file of PolyData, versions 1 to 5.1, with its title and the arrays of points and cells that
/// `wanted` names. Indices of polygons and strips are below the number of points; others are not
/// checked. Throws Error(InvalidInput) with the line or byte, the finding and the expectation, and
/// Error(Unsupported) for other data sets.
VtkPolyData parseVtkLegacy(std::string_view bytes, const std::string& name,
                           std::span<const std::string_view> wanted);

}  // namespace lumen::convert
