// SPDX-License-Identifier: Apache-2.0
// A volume's grid without its place in space.
#pragma once

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Millimetres along the axes of a grid, from its first voxel, with a spacing rounded to six
/// digits. Formats state origin, directions and spacing to six or seven digits, and the last bits
/// of a sum depend on the origin: here the same voxels have the same numbers whatever container
/// they came in, so that these decide nothing.
VolumeGeometry gridGeometry(const VolumeGeometry& world);

/// A point, mm, in the frame `from` of a grid, in the frame `to` of that grid.
inline Eigen::Vector3d inFrame(const VolumeGeometry& from, const VolumeGeometry& to,
                               const Eigen::Vector3d& point) {
  return to.worldFromIndex(from.indexFromWorld(point));
}

}  // namespace lumen::convert
