// SPDX-License-Identifier: Apache-2.0
// The contrast of a disc across a vessel against the ring around it.
#pragma once

#include <Eigen/Core>

#include "converters/voxels/bspline.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Evidence of vessels in one volume. Thread-safe; the volume must outlive it.
class Evidence {
public:
  /// `smoothing`: standard deviation of a Gaussian that the voxels are smoothed with, mm.
  Evidence(const Volume& volume, bool dark, double smoothing);

  /// The mean of the disc of `radius` mm across `direction` (unit) at `centre` (mm, LPS), less that of
  /// the ring at 1.7 radii, in the voxels' units; positive for a vessel. Zero where a part of either
  /// lies outside of the volume.
  [[nodiscard]] double contrastAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction,
                                  double radius) const;

  /// The same for the last disc of a vessel that ends a radius farther on: also less than the mean of the
  /// disc two radii on in the direction `outward`.
  [[nodiscard]] double contrastOfEnd(const Eigen::Vector3d& centre,
                                     const Eigen::Vector3d& direction,
                                     const Eigen::Vector3d& outward, double radius) const;

private:
  struct Disc {
    double inside, around;
  };
  [[nodiscard]] Disc discAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction,
                            double radius) const;

  BsplineVolume m_voxels;
  double m_sign;
};

}  // namespace lumen::convert
