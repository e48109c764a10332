// SPDX-License-Identifier: Apache-2.0
// Reader of VTK's XML files of polygonal data (.vtp): VTK file formats, Kitware, section "XML file
// formats".
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "converters/io/vtk/vtk_poly_data.h"

namespace lumen {

/// The data of `text`, a whole file: all pieces merged, with the arrays of points and of cells that
/// `wanted` names and that all pieces have. Data may be ascii, binary (base64) or appended (raw or
/// base64), in either byte order, plain or packed by zlib. Memory is bounded by the size of the
/// text, packed data by zlib's maximum expansion. Throws Error(InvalidInput) with `name`, the line,
/// the finding and the expectation, and Error(Unsupported) for other compressors and data other
/// than polygons.
VtkPolyData parseVtkXml(std::string_view text, const std::string& name,
                        std::span<const std::string_view> wanted);

}  // namespace lumen
