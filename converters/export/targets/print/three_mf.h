// SPDX-License-Identifier: Apache-2.0
// 3MF, the file of 3D printers: 3MF Core Specification 1.3 (3MF Consortium), an Open Packaging
// Conventions zip.
#pragma once

#include <string>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// One object called `name`, in mm; triangles have the material of their system of vessels, where the
/// mesh states systems. Equal meshes give equal bytes, which lib3mf does not promise:
/// it writes the time. Throws Error(Failed) if zlib refuses, Error(Unsupported) from 4 GiB on.
std::string encode3mf(const SurfaceMesh& mesh, const std::string& name);

}  // namespace lumen::convert
