// SPDX-License-Identifier: Apache-2.0
// Tubes to track, and clicks on them.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/random.h"
#include "converters/stages/tracking/track_case.h"
#include "tube_volume.h"

namespace lumen::convert {

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
