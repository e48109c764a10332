// SPDX-License-Identifier: Apache-2.0
// Motions of bones between two scans (docs/method.md, section 1.13).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/base/progress.h"
#include "converters/stages/finding/ct_levels.h"
#include "converters/voxels/bspline.h"
#include "converters/voxels/volume.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// Computed tomography, its levels, and its values between voxels.
struct CtScan {
  CtScan(const Volume& scan, const CtLevels& ofTissue)
      : volume(scan), levels(ofTissue), spline(scan) {}
  const Volume& volume;
  CtLevels levels;
  BsplineVolume spline;

  [[nodiscard]] float value(std::size_t voxel) const {
    return std::visit([voxel](const auto& voxels) { return static_cast<float>(voxels[voxel]); },
                      volume.voxels);
  }
  /// The excess over soft tissue at a position in index space; not finite outside.
  [[nodiscard]] float excessAt(const Eigen::Vector3d& index) const {
    const float level = spline.sample(index);
    return std::isfinite(level) ? std::max(level - levels.soft, 0.0F) : level;
  }
};

/// Bone of a scan without contrast, with a rim around it, and how it moved.
struct MovedBone {
  static constexpr std::uint8_t kUnmatched = 255;  ///< bone whose motion is not found
  static constexpr std::uint8_t kOutside = 254;    ///< it lies outside of the other scan

  std::unique_ptr<const VoxelSet> rim;     ///< voxels of bone, and those that blur it
  std::vector<bool> isBone;                ///< of each voxel of `rim`
  std::vector<float> slope;                ///< the same: voxel units for a millimetre
  std::vector<std::uint8_t> piece;         ///< the same: the motion by which it moved
  std::vector<float> error;                ///< the same: displacement that is left around it, mm
  std::vector<Eigen::Isometry3d> motions;  ///< from this scan to the other one, mm, LPS
};

/// Finds the motions by which most of the bone of `native` comes to lie on that of `contrast`, most
/// bone first. Bone whose place stays doubtful by more than a voxel is unmatched. Throws
/// Error(Cancelled).
MovedBone findMotions(const CtScan& native, const CtScan& contrast, const Progress& progress);

}  // namespace lumen::convert
