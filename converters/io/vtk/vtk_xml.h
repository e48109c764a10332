// SPDX-License-Identifier: Apache-2.0
// VTK's XML files of polygonal data (.vtp), in: VTK file formats, Kitware, section "XML file formats".
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen {

/// The data of `text`, a whole file: all pieces as one, with the arrays of points and of cells that
/// `wanted` names and that all pieces have. Data may be ascii, binary (base64) or appended (raw
/// or base64), in either order of bytes, as they are or packed by zlib. Memory is bounded by the
/// size of the text, packed data by what zlib can pack into it. Throws Error(InvalidInput) with
/// `name`, the line, what was found and what was expected, and Error(Unsupported) for other packers
/// and other data than polygons.
VtkPolyData parseVtkXml(std::string_view text, const std::string& name,
                        std::span<const std::string_view> wanted);

}  // namespace lumen
