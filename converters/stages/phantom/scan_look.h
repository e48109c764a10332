// SPDX-License-Identifier: Apache-2.0
// The look of a real scan, measured in its voxels: levels, noise and blur.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Levels and standard deviations are in the volume's units. *Soft* voxels are those of even tissue:
/// neither air nor as bright as bone.
struct ScanLook {
  double border = 0;  ///< level between air and tissue
  double tissue = 0;  ///< median of the soft voxels
  double reach = 0;   ///< greatest difference of a soft voxel from `tissue`
  double noise = 0;   ///< standard deviation of the noise in soft tissue
  /// Correlation of the noise of neighbours along each index axis.
  Eigen::Vector3d grain = Eigen::Vector3d::Zero();
  /// mm along each index axis, standard deviation of the Gaussian whose blur makes an edge as wide as
  /// edges are. It holds the voxel's own box as well as the scanner.
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();

  [[nodiscard]] bool isSoft(double value) const {
    return value > border && std::abs(value - tissue) <= reach;
  }
};

/// The look of a scan with air around soft tissue, as CT has it. The border of the air is Otsu's
/// ("A threshold selection method from gray-level histograms", 1979). The noise is the
/// lower quartile over the blocks of soft voxels, each without its slope. The spread is the lower
/// quartile over places on the surface towards the air, of those that face along the axis. Throws
/// Error(InvalidInput) if the volume has no block of soft tissue or no such surface, and
/// Error(Cancelled).
ScanLook measureScan(const Volume& volume, const Progress& progress);

/// Whether each voxel is air that reaches the volume's faces: 1 or 0, by the voxel's index.
std::vector<std::uint8_t> outerAir(const Volume& volume, double border);

/// The value of a voxel.
double valueAt(const Volume& volume, std::size_t index);

}  // namespace lumen::convert
