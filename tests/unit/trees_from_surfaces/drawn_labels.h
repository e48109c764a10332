// SPDX-License-Identifier: Apache-2.0
// Small volumes of labels, drawn by a function.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/voxels/volume.h"

namespace lumen::convert::test {

using LabelAt = std::function<int(const Eigen::Vector3d&)>;

/// 40 x 32 x 32 voxels in which `label` says what is where, mm from the first voxel's centre.
inline Volume drawn(const Eigen::Vector3d& spacing, const LabelAt& label) {
  using Eigen::Vector3d;
  Volume volume;
  volume.geometry.size = {40, 32, 32};
  volume.geometry.spacing = spacing;
  volume.geometry.origin = Vector3d(5, -7, 9);
  volume.geometry.direction = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).matrix();
  std::vector<std::uint8_t> voxels;
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 40; ++i)
        voxels.push_back(static_cast<std::uint8_t>(label(spacing.cwiseProduct(Vector3d(i, j, k)))));
  volume.voxels = std::move(voxels);
  return volume;
}

/// mm from a segment.
inline double away(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

}  // namespace lumen::convert::test
