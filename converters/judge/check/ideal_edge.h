// SPDX-License-Identifier: Apache-2.0
// Where the edge of a round vessel appears that a scanner has blurred (docs/method.md, section 7.1).
#pragma once

#include <vector>

namespace lumen::convert {

/// How far in profiles reach from the wall of a vessel of this radius, and how far out; mm.
struct ProfileReach {
  double inward, outward;
};
ProfileReach profileReach(double radius, double voxel);

/// The displacement of the edge that findEdge() sees at the wall of a cylinder or a ball which a
/// Gaussian has blurred: measured on exact profiles, so it holds for that definition of an edge.
class IdealEdge {
public:
  /// `pointSpread`: standard deviation of the Gaussian, mm; 0: nothing is displaced.
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
