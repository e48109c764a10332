// SPDX-License-Identifier: Apache-2.0
// Surfaces of VTK: XML (.vtp) and the legacy format (.vtk); VTK File Formats, Kitware.
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The polygons (as fans) and strips of an XML PolyData file. The integers of a cell array
/// ModelFaceID are groups named by their numbers. Lines and points are ignored.
MeshFile parseVtp(std::string_view bytes, const std::string& name);

/// The polygons, strips and groups of a legacy file, versions 1 to 5, ASCII or binary. A file whose
/// title has SPACE=RAS, as 3D Slicer writes it, is turned to LPS.
MeshFile parseVtk(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
