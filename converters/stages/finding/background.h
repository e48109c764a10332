// SPDX-License-Identifier: Apache-2.0
// The intensity and the noise around vessels, which vary slowly over a volume.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Background by blocks of voxels: the lower quartile of the medians of the blocks around each
/// place, so that a vessel that fills a block does not count. Brighter is more, also where vessels
/// are dark. Voxels that are no image do not count.
class Background {
public:
  static constexpr int kBlock = 16;  ///< voxels along an edge

  /// `sign`: 1, or -1 if vessels are darker than their background. Throws Error(Cancelled).
  Background(const Volume& volume, float sign, const Progress& progress);

  /// The intensity (times the sign) of the background at each voxel of a row along x, linear
  /// between the middles of blocks. `row` has a value for each voxel of the row.
  void alongRow(int y, int z, std::vector<float>& row) const;

  /// Standard deviation of the noise, voxel units: the lower quartile over the blocks of 1.4826
  /// times the median absolute deviation; for voxels of whole numbers at least that of rounding.
  [[nodiscard]] float noise() const { return m_noise; }
  /// Standard deviation of the noise around a voxel, voxel units, where tissue is uneven: at least
  /// noise().
  [[nodiscard]] float noiseAt(const Cell& cell) const;

private:
  /// The place of a voxel between the middles of two blocks.
  struct Between {
    int low = 0, high = 0;
    float share = 0;  ///< of the way from low to high
  };
  static Between between(int voxel, int blocks);
  void smoothOver(const std::vector<float>& medians, const std::vector<float>& deviations);

  CellBox m_voxels, m_blocks;
  std::vector<float> m_level, m_unevenness;
  std::vector<Between> m_alongX;
  float m_noise = 0;
};

}  // namespace lumen::convert
