// SPDX-License-Identifier: Apache-2.0
// Cubic B-spline interpolation of a volume, with coefficients computed brick by brick when first
// needed. ITK's BSplineDecompositionImageFilter and BSplineInterpolateImageFunction do the same
// computation, but compute all coefficients of the volume before the first sample, while tracking
// needs only those along the vessels; they smooth by another pass over another copy, and their bits
// are not reproducible. Here the smoothing is folded into the prefilter's taps, and the floats are
// equal on every machine and with any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The cubic B-spline that interpolates the voxels (Unser, "Splines: a perfect fit for signal and
/// image processing", 1999), mirrored at the volume's faces; the volume is first smoothed by a
/// Gaussian of `smoothing` mm along each index axis, unless that is zero. Sampling is thread-safe;
/// the values do not depend on the order of calls. The volume must outlive the sampler. Memory: one
/// 4-byte coefficient for each voxel of the bricks that were touched, and about a third for their
/// shared rims.
class BsplineVolume {
public:
  explicit BsplineVolume(const Volume& volume,
                         const Eigen::Vector3d& smoothing = Eigen::Vector3d::Zero());
  /// The voxels as if `geometry`, of the same size, were theirs.
  BsplineVolume(const Volume& volume, const VolumeGeometry& geometry,
                const Eigen::Vector3d& smoothing);
  ~BsplineVolume();
  BsplineVolume(const BsplineVolume&) = delete;
  BsplineVolume& operator=(const BsplineVolume&) = delete;

  [[nodiscard]] const VolumeGeometry& geometry() const;

  /// Values at index positions start + n * step for n = 0 .. out.size() - 1, in the voxels' units;
  /// NaN where VolumeGeometry::containsIndex() is false. SIMD by run-time dispatch.
  void sampleLine(const Eigen::Vector3d& startIndex, const Eigen::Vector3d& stepIndex,
                  std::span<float> out) const;
  /// The scalar reference for sampleLine: the same values to float rounding.
  void sampleLineReference(const Eigen::Vector3d& startIndex, const Eigen::Vector3d& stepIndex,
                           std::span<float> out) const;
  /// One value at an index position; NaN outside.
  [[nodiscard]] float sample(const Eigen::Vector3d& index) const;

  /// The maximum of `smoothing`, in voxel edges: its taps then fit the halo.
  static constexpr double kMostSmoothing = 2.0;

  /// Memory of the current coefficients, bytes.
  [[nodiscard]] std::size_t coefficientBytes() const;

private:
  struct Bricks;
  std::unique_ptr<Bricks> m_bricks;
};

}  // namespace lumen::convert
