// SPDX-License-Identifier: Apache-2.0
// How well the triangles of a mesh are shaped.
#pragma once

#include <cstddef>
#include <span>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// A triangle with a smaller angle is a sliver that solvers stumble over, radians (15 degrees).
constexpr double kSharpAngle = 0.2617993877991494;

/// The squared sine of a triangle's least angle, which is never above 60 degrees: it grows with that
/// and costs no root. 0 if the triangle has no area.
double squaredSine(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// The least angle of a triangle, radians; 0 if it has no area.
double leastAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Angles in degrees.
struct TriangleQuality {
  std::size_t triangles = 0;
  std::size_t sharp = 0;   ///< triangles with an angle under kSharpAngle
  double medianAngle = 0;  ///< median of the triangles' least angles
  double leastAngle = 0;   ///< of all triangles
  /// Edge length over the mean of the targets at its ends: median, and the range that holds 90 %.
  /// 0 without targets.
  double edgeMedian = 0, edgeLow = 0, edgeHigh = 0;
};

/// `target`: the length that edges at each vertex should have, mm, or empty.
TriangleQuality triangleQuality(const TriangleMesh& mesh, std::span<const double> target = {});

}  // namespace lumen::convert
