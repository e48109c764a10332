// SPDX-License-Identifier: Apache-2.0
// The frame in which vessels are tracked, so that a volume's place in space decides nothing.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/tracked_branch.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The frame of gridGeometry().
class GridFrame {
public:
  explicit GridFrame(const VolumeGeometry& world);

  [[nodiscard]] const VolumeGeometry& geometry() const { return m_grid; }
  /// Seeds in this frame, at places a thousandth of a voxel apart.
  [[nodiscard]] std::vector<SeedBranch> toGrid(std::vector<SeedBranch> seeds) const;
  [[nodiscard]] Eigen::Vector3d toWorld(const Eigen::Vector3d& point) const;  ///< mm, LPS
  void toWorld(TrackedBranch& branch) const;

private:
  VolumeGeometry m_world, m_grid;
};

}  // namespace lumen::convert
