// SPDX-License-Identifier: Apache-2.0
// Computed tomography with contrast, less the bone of a scan without (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Bone that moved as one from a scan without contrast to the one with it.
struct NativePiece {
  double volume = 0;                                ///< of bone, mm^3
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of its middle, mm, LPS
  double rotation = 0;                              ///< degrees
  double residual = 0;                              ///< mm: the median displacement that is left
  double difference = 0;  ///< Hounsfield units: the median deviation after subtraction
};

/// Subtraction in figures.
struct NativeReport {
  std::string name;                 ///< of the scan without contrast
  std::vector<NativePiece> pieces;  ///< those that were subtracted, the largest first
  double unmatched = 0;             ///< mm^3 of bone that no motion matches, left as it was
  double outside = 0;               ///< mm^3 of bone beyond the scan with contrast
  double doubtful = 0;              ///< mm^3 at steep edges of bone that were made soft tissue
};

/// The result of the subtraction, on the grid of the scan with contrast.
struct NativeSubtraction {
  Volume volume;
  NativeReport report;
};

/// The scan `contrast` less the bone of `native`, each piece of which is registered alone. Where the
/// displacement that is left may change a voxel by as much as contrast does, it becomes soft tissue.
/// Throws Error(InvalidInput) if a volume is no computed tomography, if no bone of one lies on that
/// of the other, or if no blood has contrast in `contrast` alone; messages begin with the name of
/// the volume. Throws Error(Unsupported) if lumen was built without ITK, and Error(Cancelled).
NativeSubtraction subtractNative(const Volume& contrast, const std::string& contrastName,
                                 const Volume& native, const std::string& nativeName,
                                 Progress& progress);

}  // namespace lumen::convert
