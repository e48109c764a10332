// SPDX-License-Identifier: Apache-2.0
// Layers of prisms at the wall, and the surface of what they leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/mesh/volume_mesh.h"
#include "converters/stages/volume_mesh/layer_base.h"
#include "converters/stages/volume_mesh/volume_options.h"

namespace lumen::convert {

/// Prisms at the wall, and the closed surface of the lumen within them. Vertices of the layers come first: the
/// base's, then those of each layer towards the axis; then new ones of the inner flat ends.
struct WallLayers {
  VolumeMesh mesh;  ///< prisms, with the faces of the boundary that they and inner ends have
  std::vector<Triangle>
      inner;                  ///< faces of the space within, counter-clockwise seen from the layers
  std::vector<double> share;  ///< height of all layers at each vertex of the base, as a share of
                              ///< that asked for
};

/// Layers on the base along `direction`. Heights are those of the options for the radius at each vertex
/// of the surface. They are less where the opposite wall is near, at most a quarter of the distance to
/// it, and shrink until each prism keeps a quarter of the quality that its triangle allows, or half of that of the
/// thinnest prism where the surface is sharper, inner ends
/// can be cut into triangles, and the inner surface crosses itself nowhere; they change by a
/// quarter of the distance between vertices at most. So layers end nowhere. Throws Error(Failed) with the place where no height is
/// small enough, and Error(Cancelled).
WallLayers wallLayers(const LayerBase& base, const std::vector<Eigen::Vector3d>& direction,
                      const SurfaceMesh& surface, const VolumeMeshOptions& options,
                      Progress& progress);

}  // namespace lumen::convert
