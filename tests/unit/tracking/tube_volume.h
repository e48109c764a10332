// SPDX-License-Identifier: Apache-2.0
// Synthetic tubes drawn from a signed distance, for tests of the tracker.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/random.h"
#include "converters/stages/tracking/track_case.h"
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

/// Signed distance to a box.
inline double inBox(const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& high) {
  return ((p - 0.5 * (low + high)).cwiseAbs() - 0.5 * (high - low)).maxCoeff();
}

/// Makes the value of a voxel that of another tissue where this lies, at a signed distance in voxels.
inline void mix(double& value, double other, double distance) {
  value += (other - value) * std::clamp(0.5 - distance / 1.5, 0.0, 1.0);
}

// Tubes to track, and clicks on them.
using Eigen::Vector3d;

/// Ends of the straight tube.
inline const Vector3d kLow(6.4, 6.4, 0.4), kHigh(6.4, 6.4, 12.2);

inline SeedBranch seedAt(std::string label, const Vector3d& point,
                         std::optional<double> radius = {}) {
  SeedBranch seed;
  seed.label = std::move(label);
  seed.points.push_back({point, radius});
  return seed;
}

inline Volume straightTube(double radius) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) { return capsule(p, kLow, kHigh, radius); });
}

inline TrackResult trackOne(const Volume& volume, const std::vector<SeedBranch>& seeds) {
  Progress silent;
  return trackFromSeeds(volume, seeds, TrackOptions{}, silent);
}

/// A T: a child of half the trunk's radius leaves its middle along x.
inline Volume tee(double childRadius) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) {
    return std::min(capsule(p, kLow, kHigh, 1.2),
                    capsule(p, {6.4, 6.4, 6.4}, {12.2, 6.4, 6.4}, childRadius));
  });
}

/// With normal noise of that standard deviation, the same every time.
inline Volume noisy(Volume volume, double deviation) {
  Random random(11);
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(volume.voxels))
    voxel = static_cast<std::int16_t>(std::lround(voxel + deviation * random.normal()));
  return volume;
}

}  // namespace lumen::convert
