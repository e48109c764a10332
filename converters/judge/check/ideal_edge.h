// SPDX-License-Identifier: Apache-2.0
// Apparent edge of a round vessel under the blur of a scanner (docs/method.md, section 7.1).
#pragma once

#include <vector>

namespace lumen::convert {

/// Displacement of the edge that findEdge() detects at the wall of a cylinder or a ball blurred by
/// a Gaussian: measured on exact profiles, so it holds for findEdge()'s definition of an edge.
class IdealEdge {
public:
  /// `pointSpread`: standard deviation of the Gaussian, mm; 0: no displacement.
  IdealEdge(double pointSpread, double voxel);

  /// mm outward of the wall, so less than 0 where vessels appear too narrow.
  [[nodiscard]] double ofCylinder(double radius) const { return at(m_cylinder, radius, 0.5); }
  [[nodiscard]] double ofBall(double radius) const { return at(m_ball, radius, 1.0); }

private:
  [[nodiscard]] double at(const std::vector<double>& table, double radius, double bends) const;

  double m_sigma, m_voxel;
  std::vector<double> m_cylinder, m_ball;  ///< by radius, in steps of kRadiusStep voxels
};

}  // namespace lumen::convert
