// SPDX-License-Identifier: Apache-2.0
#include "closed_mesh.h"

#include "converters/stages/surface/closed_surface.h"

namespace lumen::bench {

Triangles closedMesh(const formats::Case& source) {
  convert::ClosedSurfaceOptions options;
  options.edge.share = 0.5;
  Progress progress;
  const convert::SurfaceMesh surface =
      convert::closedSurface(source, options, progress).levels.front();
  Triangles result;
  result.closed = true;
  for (const convert::Float3& p : surface.position) result.vertex.push_back({p[0], p[1], p[2]});
  for (const convert::Triangle& t : surface.triangle) result.face.push_back({t[0], t[1], t[2]});
  return result;
}

}  // namespace lumen::bench
