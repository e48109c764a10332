// SPDX-License-Identifier: Apache-2.0
// STL, binary and ASCII (3D Systems, "StereoLithography Interface Specification", 1989).
#pragma once

#include <string>
#include <string_view>

#include "converters/io/mesh/mesh_file.h"

namespace lumen::convert {

/// The triangles of an STL file, points of equal coordinates merged; a file is binary if its size
/// matches its count, or if it does not begin with "solid". Each solid of an ASCII file is a group
/// of its name. Normals and attributes are ignored: the order of corners gives the orientation.
MeshFile parseStl(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
