// SPDX-License-Identifier: Apache-2.0
// Options and results of a volume mesh.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "converters/base/field_word.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

struct VolumeMeshOptions {
  FieldWord word{};        ///< names fields of the options in messages
  int layers = 3;          ///< layers of prisms at the wall; 0: tetrahedra alone
  double growth = 1.25;    ///< height of a layer over that of the one before it, towards the axis
  Length height{0, 0.05};  ///< height of the layer at the wall

  /// Height of all layers over that of the one at the wall.
  [[nodiscard]] double heights() const;
};

/// Facts of a volume mesh. Lengths are in mm.
struct VolumeMeshReport {
  std::size_t points = 0, prisms = 0, tetrahedra = 0;
  double volume = 0;                                     ///< sum over cells, mm^3
  double surfaceVolume = 0;                              ///< enclosed by the surface, mm^3
  double leastQuality = 0;                               ///< least scaled Jacobian of a cell
  Eigen::Vector3d leastPlace = Eigen::Vector3d::Zero();  ///< a corner of that cell, LPS
  double fullLayers = 1;   ///< share of the wall's vertices where layers have the height asked for
  double leastLayers = 1;  ///< least height of all layers at a vertex, as a share of that asked for
};

}  // namespace lumen::convert
