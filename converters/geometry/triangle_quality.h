// SPDX-License-Identifier: Apache-2.0
// Shape quality of the triangles of a mesh.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Geometry>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// Angle below which a triangle is a sliver that harms solvers, radians (15 degrees).
constexpr double kSharpAngle = 0.2617993877991494;
constexpr double kSharpSquaredSine = 0.06698729810778068;  ///< squaredSine() at kSharpAngle

/// The squared sine of a triangle's least angle, which is never above 60 degrees: it is monotone in
/// that angle and needs no square root. 0 if the triangle has no area.
inline double squaredSine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, bc = c - b, ca = a - c;
  const double p = ab.squaredNorm(), q = bc.squaredNorm(), r = ca.squaredNorm();
  // It lies across the shortest edge: sin = 2 A / (product of the other two).
  const double others = p < q ? (p < r ? q * r : p * q) : (q < r ? p * r : p * q);
  return others > 0 ? ab.cross(ca).squaredNorm() / others : 0;
}

/// The least angle of a triangle, radians; 0 if it has no area.
double leastAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Angles in degrees.
struct TriangleQuality {
  std::size_t triangles = 0;
  std::size_t sharp = 0;   ///< triangles with an angle under kSharpAngle
  double medianAngle = 0;  ///< median of the triangles' least angles
  double leastAngle = 0;   ///< smallest angle of all triangles
  /// Edge length over the mean of the targets at its ends: median, and the range that holds 90 %.
  /// 0 without targets.
  double edgeMedian = 0, edgeLow = 0, edgeHigh = 0;
};

/// `target`: the desired edge length at each vertex, mm, or empty.
TriangleQuality triangleQuality(const TriangleMesh& mesh, std::span<const double> target = {});

}  // namespace lumen::convert
