// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/volume_mesh_of.h"

#include <utility>

#include "converters/base/error.h"
#include "converters/stages/volume_mesh/make_volume_mesh.h"

namespace lumen::operations {

VolumeMesh volumeMeshOf(const formats::Case& value, const convert::ClosedSurfaceOptions& surface,
                        const convert::VolumeMeshOptions& cells, const std::string& name,
                        const Context& context) {
  SurfaceOptions options;
  options.closed = surface;
  options.closed.levels = 1;
  options.closed.fewTriangles = false;  // long triangles make flat cells
  Surface closed = surfaceOf(value, options, name, context);
  if (closed.report->crossings > 0)
    throw failed(
        "the surface crosses itself, so it has no inside that cells could fill; a greater " +
        context.field("gap") + " or a smaller " + context.field("edge") + " may help");
  convert::MadeVolumeMesh made = convert::makeVolumeMesh(
      value, closed.levels.front(), closed.report->gap, cells, context.progress);
  return {std::move(made.mesh), std::move(closed.report), made.report};
}

}  // namespace lumen::operations
