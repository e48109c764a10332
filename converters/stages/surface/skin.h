// SPDX-License-Identifier: Apache-2.0
// The motion of a case as bones of its surface, for programs that know linear blend skinning.
#pragma once

#include <vector>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/io/mesh/write_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Bones of the surfaces of a case with models and a motion. A joint is a moving node whose blobs
/// take part; all resting nodes share one. A vertex hangs on the nodes whose local fields blend at
/// its place at rest, with their weights there, on the four greatest of them if there are more: to
/// first order it then stays on the wall of the posed case (spec/lumen.md, "The posed case"). A periodic
/// motion ends with the poses that it begins with.
MeshSkin skinOf(const formats::Case& source, const std::vector<SurfaceMesh>& levels);

}  // namespace lumen::convert
