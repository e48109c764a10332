// SPDX-License-Identifier: Apache-2.0
// The one place where a case becomes the surface that mesh formats write.
#pragma once

#include <filesystem>
#include <vector>

#include "converters/app/file_format.h"
#include "converters/common/progress.h"
#include "converters/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::app {

/// The surface, and `levels` - 1 coarser ones behind it, all with the same groups and labels. Warns
/// of what the mesh in `file` lacks.
std::vector<convert::SurfaceMesh> meshOfCase(const formats::Case& value,
                                             const std::filesystem::path& file,
                                             const OutputOptions& options, int levels,
                                             Progress& progress);

}  // namespace lumen::app
