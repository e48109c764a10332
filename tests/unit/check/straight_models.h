// SPDX-License-Identifier: Apache-2.0
// Models of straight vessels of one radius whose surface is known exactly.
#pragma once

#include <cmath>
#include <cstdint>

#include "converters/base/vectors.h"
#include "formats/case/blobby.h"
#include "formats/case/case.h"

namespace lumen::convert {

inline constexpr double kVoxel = 0.2, kBlur = 0.6 * kVoxel;  ///< mm, the phantoms' own

/// Gives every node a long row of blobs along its direction, with the iso-level at which the surface
/// has this radius, mm. All branches have one radius.
inline void addStraightModels(formats::Case& value, double radius) {
  constexpr int kBlobs = 40;     // on either side of the node
  constexpr double kStep = 0.2;  // of the blobs' width
  const double width = radius;
  formats::BlobbyModels models;
  models.offset.push_back(0);
  for (std::size_t n = 0; n < value.tree.nodeCount(); ++n) {
    const Eigen::Vector3d centre = toEigen(value.tree.centre[n]);
    const Eigen::Vector3d along = toEigen(value.tree.direction[n]);
    for (int i = -kBlobs; i <= kBlobs; ++i) {
      models.centre.push_back(toVec3f(centre + i * kStep * width * along));
      models.width.push_back(static_cast<float>(width));
    }
    models.offset.push_back(static_cast<std::uint32_t>(models.centre.size()));
  }
  const auto [u, v] = planeBasis(toEigen(value.tree.direction[0]).normalized());
  const Eigen::Vector3d wall = toEigen(value.tree.centre[0]) + radius * u;
  models.isoLevel = formats::evaluateField(models, 0, toVec3d(wall)).f;
  value.models = models;
}

}  // namespace lumen::convert
