// SPDX-License-Identifier: Apache-2.0
// The inside of the vessels of a case as cells for solvers.
#pragma once

#include <optional>
#include <string>

#include "converters/io/mesh/volume_mesh.h"
#include "converters/operations/context.h"
#include "converters/operations/surface_of.h"
#include "converters/stages/volume_mesh/volume_options.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct VolumeMesh {
  convert::VolumeMesh mesh;  ///< mm, LPS
  std::optional<convert::SurfaceReport> surface;
  convert::VolumeMeshReport cells;
};

/// Prisms at the wall and tetrahedra within the closed surface that surfaceOf() makes with these options,
/// which have neither a thickness nor open ends. Warns as surfaceOf(). Takes seconds to minutes. Throws as
/// surfaceOf() and convert::makeVolumeMesh(), and Error(Failed) for a surface that crosses itself.
VolumeMesh volumeMeshOf(const formats::Case& value, const convert::ClosedSurfaceOptions& surface,
                        const convert::VolumeMeshOptions& cells, const std::string& name,
                        const Context& context);

}  // namespace lumen::operations
