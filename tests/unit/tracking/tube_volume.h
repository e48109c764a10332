// SPDX-License-Identifier: Apache-2.0
// Synthetic tubes drawn from a signed distance, for tests of the tracker.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// A volume of 1000 where `distance` (mm, negative inside; LPS) is below zero and 0 outside, with a linear
/// ramp over 1.5 voxels across the wall.
inline Volume drawVolume(int size, double voxel,
                         const std::function<double(const Eigen::Vector3d&)>& distance) {
  Volume volume;
  volume.geometry.size = {size, size, size};
  volume.geometry.spacing.setConstant(voxel);
  std::vector<std::int16_t> voxels;
  voxels.reserve(volume.geometry.voxelCount());
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const double d = distance(volume.geometry.worldFromIndex(Eigen::Vector3d(i, j, k)));
        const double inside = std::clamp(0.5 - d / (1.5 * voxel), 0.0, 1.0);
        voxels.push_back(static_cast<std::int16_t>(std::lround(1000 * inside)));
      }
  volume.voxels = std::move(voxels);
  return volume;
}

/// Signed distance to the tube of `radius` around the segment a-b, rounded at its ends.
inline double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      double radius) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - radius;
}

}  // namespace lumen::convert
