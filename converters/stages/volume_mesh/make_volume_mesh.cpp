// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/volume_mesh/make_volume_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "converters/stages/volume_mesh/fill_tetrahedra.h"
#include "converters/stages/volume_mesh/wall_layers.h"

namespace lumen::convert {

namespace {

// Difference of volumes that rounding may make, as a share.
constexpr double kRounding = 1e-6;
// Share of the height asked for from which a vertex counts as one with full layers.
constexpr double kFull = 0.99;

TriangleMesh inDoubles(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  for (const Float3& p : surface.position) mesh.position.push_back(toEigen(p));
  mesh.triangle = surface.triangle;
  return mesh;
}

/// No layers: the inner surface is the surface.
WallLayers noLayers(const SurfaceMesh& surface) {
  WallLayers layers;
  TriangleMesh mesh = inDoubles(surface);
  layers.mesh.position = std::move(mesh.position);
  layers.inner = std::move(mesh.triangle);
  for (std::size_t t = 0; t < layers.inner.size(); ++t) {
    const Triangle& c = layers.inner[t];
    layers.mesh.boundary.push_back({{c[0], c[1], c[2], kAbsent}, surface.group[t]});
  }
  return layers;
}

WallLayers layersOn(const formats::Case& source, const SurfaceMesh& surface, double gap,
                    const VolumeMeshOptions& options, Progress& progress) {
  progress.begin("layers", 0);
  const LayerBase base = layerBase(surface);
  WallLayers layers =
      wallLayers(base, layerDirections(base, surface, source, gap), surface, options, progress);
  progress.end();
  return layers;
}

void reportShares(const std::vector<double>& share, VolumeMeshReport& report) {
  std::size_t full = 0;
  for (const double s : share) {
    full += s >= kFull ? 1U : 0U;
    report.leastLayers = std::min(report.leastLayers, s);
  }
  if (!share.empty())
    report.fullLayers = static_cast<double>(full) / static_cast<double>(share.size());
}

/// Sums volumes, and throws for a cell that is turned over, for faces that do not meet, and for a
/// wrong sum.
void check(const VolumeMesh& mesh, VolumeMeshReport& report) {
  report.leastQuality = INFINITY;
  for (std::size_t cell = 0; cell < mesh.cells(); ++cell) {
    const double volume = cellVolume(mesh, cell), quality = cellQuality(mesh, cell);
    const std::uint32_t corner = facesOf(mesh, cell)[0][0];
    if (!(volume > 0 && quality > 0))
      throw failed("a cell of the volume mesh is turned over at " +
                   joinedNumbers(mesh.position[corner], ", ", 5) + " mm");
    report.volume += volume;
    if (quality < report.leastQuality) {
      report.leastQuality = quality;
      report.leastPlace = mesh.position[corner];
    }
  }
  cellFaces(mesh);
  if (!(std::abs(report.volume - report.surfaceVolume) <= kRounding * report.surfaceVolume))
    throw failed("the cells of the volume mesh have " + shownNumber(report.volume) +
                 " mm^3, and the surface encloses " + shownNumber(report.surfaceVolume));
}

}  // namespace

MadeVolumeMesh makeVolumeMesh(const formats::Case& source, const SurfaceMesh& surface, double gap,
                              const VolumeMeshOptions& options, Progress& progress) {
  WallLayers layers =
      options.layers > 0 ? layersOn(source, surface, gap, options, progress) : noLayers(surface);
  const TriangleMesh space{layers.mesh.position, layers.inner};
  Tetrahedra inside = fillTetrahedra(space, options.word, progress);
  MadeVolumeMesh made{std::move(layers.mesh), {}};
  made.mesh.groups = surface.groups;
  made.mesh.position.insert(made.mesh.position.end(), inside.added.begin(), inside.added.end());
  made.mesh.tetrahedron = std::move(inside.cell);
  VolumeMeshReport& report = made.report;
  report.points = made.mesh.position.size();
  report.prisms = made.mesh.prism.size();
  report.tetrahedra = made.mesh.tetrahedron.size();
  report.surfaceVolume = signedVolume(inDoubles(surface));
  reportShares(layers.share, report);
  check(made.mesh, report);
  return made;
}

}  // namespace lumen::convert
