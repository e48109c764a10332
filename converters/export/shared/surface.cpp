// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/surface.h"

#include <cstddef>
#include <utility>

#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

ExportedSurface surfaceWith(const ExportInput& input, const ClosedSurfaceOptions& options) {
  ClosedSurface made = closedSurface(input.source, options, input.progress);
  ExportedSurface result;
  result.ends = findEnds(made.levels.front());
  result.mesh = input.frame.of(std::move(made.levels.front()));
  for (std::size_t level = 1; level < made.levels.size(); ++level)
    result.coarser.push_back(input.frame.of(std::move(made.levels[level])));
  result.report = std::move(made.report);
  return result;
}

}  // namespace

ExportedSurface lumenSurface(const ExportInput& input, std::optional<double> gap) {
  ClosedSurfaceOptions options = input.options.surface;
  if (gap) options.gap = gap;
  options.thickness.reset();
  return surfaceWith(input, options);
}

ExportedSurface wallSurface(const ExportInput& input, const Length& usual) {
  ClosedSurfaceOptions options = input.options.surface;
  if (!options.thickness) options.thickness = usual;
  return surfaceWith(input, options);
}

Box3d boundingBox(const SurfaceMesh& mesh) {
  Box3d box;
  for (const Float3& p : mesh.position) box.add(toEigen(p));
  return box;
}

}  // namespace lumen::convert
