// SPDX-License-Identifier: Apache-2.0
// Candidate wall points around a centre (docs/method.md, section 1.2; Yureidini's thesis, 3.3).
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/voxels/bspline.h"

namespace lumen::convert {

// The wall on one ray (docs/method.md, section 1.2).

/// Where intensity falls fastest along a line of samples.
struct SteepestFall {
  double sample = 0;    ///< position in samples, between them by a parabola
  float strength = -1;  ///< difference of the two samples around; negative if there is none
};

/// The steepest fall by central differences, up to the first sample that is NaN, as those outside of
/// the volume are; the first of several. `sign`: 1, or -1 if vessels are darker than their background. A
/// fall within two samples of an end, or three of a NaN, counts as none.
SteepestFall steepestFall(std::span<const float> values, float sign);

/// Length of the rays that find the wall of a vessel, in expected radii (thesis section 3.3): rays
/// that reach a wall twice as far as expected still show it whole.
constexpr double kRayRadii = 3.0;

/// Wall candidates as a structure of arrays, in mm relative to `origin` (LPS mm).
struct Candidates {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<float> x, y, z;
  std::vector<float> strength;  ///< drop of intensity across the wall, voxel units per mm, > 0

  [[nodiscard]] std::size_t count() const { return x.size(); }
  [[nodiscard]] Eigen::Vector3d offset(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void clear();
};

/// Casts rays along the vertices of an icosphere. Not thread-safe: one per thread.
class RayCaster {
public:
  /// `directions`: unit, LPS. `dark`: vessels are darker than their background. A ray has `samples`,
  /// but no more than `mostPerEdge` for each finest edge of a voxel, of which it has one at least.
  RayCaster(const BsplineVolume& volume, std::vector<Eigen::Vector3d> directions, int samples,
            bool dark, double mostPerEdge = std::numeric_limits<double>::infinity());

  /// Rays of `length` mm from `centre` (LPS mm). On each, the place where the intensity falls
  /// fastest, refined between samples by a parabola, if its distance t holds length/12 <= t <= 0.8
  /// length. Walls outside the volume are not found.
  void cast(const Eigen::Vector3d& centre, double length, Candidates& out);

private:
  const BsplineVolume& m_volume;
  std::vector<Eigen::Vector3d> m_directions, m_indexDirections;
  std::vector<float> m_values;
  double m_mostPerEdge = 0;  ///< samples for each finest edge of a voxel
  float m_sign;
};

}  // namespace lumen::convert
