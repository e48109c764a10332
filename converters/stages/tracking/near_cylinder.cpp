// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/near_cylinder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "converters/stages/tracking/cylinder_equations.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Bounds on the radius, in expected ones: those of a depth among voxels.
constexpr double kNearLeast = 0.5, kNearMost = 1.8;
/// Radii that least squares start from, in expected ones: each finds what lies within the first
/// reach of it.
constexpr std::array kStartRadii = {1.0, 0.75, 1.3};
/// Distance from the wall at which a candidate has no weight, in radii: the first, the factor of
/// each later one, and the bound on the last, in bands of inliers.
constexpr double kFirstReach = 0.9, kNarrowing = 0.75, kReachBands = 1.5;
constexpr int kStepsPerReach = 2;
/// Weight of the expected direction, as a share of the candidates' at a radius along the axis: a
/// short set of points leaves the tilt free.
constexpr double kCourseShare = 0.02;
/// The most of a step, in radii: farther away the wall is not as it looks from here.
constexpr double kMostStep = 0.5;

/// Moves a cylinder by one step; false if too few candidates are near its wall.
bool stepRobustly(const Candidates& points, double reach, const Vector3d& course,
                  Cylinder& cylinder) {
  CylinderEquations equations = robustEquations(points, reach, cylinder);
  if (equations.weights < static_cast<double>(kFewestCandidates) / 2) return false;
  const Vector3d &e1 = equations.e1, &e2 = equations.e2;
  const double held = kCourseShare * equations.weights * cylinder.radius * cylinder.radius;
  const Vector3d away = course - cylinder.axis;
  equations.normal(2, 2) += held;
  equations.normal(3, 3) += held;
  equations.right[2] += held * away.dot(e1);
  equations.right[3] += held * away.dot(e2);
  const auto step = equations.solve();
  if (!step) return false;
  const double most = kMostStep * cylinder.radius;
  const double shift = std::hypot((*step)[0], (*step)[1]), scale = shift > most ? most / shift : 1;
  cylinder.centre += scale * ((*step)[0] * e1 + (*step)[1] * e2);
  cylinder.axis = (cylinder.axis + scale * ((*step)[2] * e1 + (*step)[3] * e2)).normalized();
  cylinder.radius += std::clamp((*step)[4], -most, most);
  return true;
}

/// The cylinder to which robust least squares lead; empty if candidates become too few on the way.
std::optional<Cylinder> converged(const Candidates& points, double band, Cylinder cylinder) {
  const Vector3d course = cylinder.axis;
  const double last = kReachBands * band;
  for (double reach = kFirstReach; reach > last; reach *= kNarrowing)
    for (int k = 0; k < kStepsPerReach; ++k)
      if (!stepRobustly(points, reach * cylinder.radius, course, cylinder)) return std::nullopt;
  return cylinder;
}

}  // namespace

Cylinder nearCylinder(const CylinderSearch& search, const Candidates& points,
                      const ExpectedCylinder& expected, CylinderWorkspace& workspace) {
  const auto& [direction, rho, smooth] = expected;
  Cylinder best;
  best.axis = direction;
  if (points.count() < kFewestCandidates) return best;
  double bestScore = 0;
  for (const double start : kStartRadii) {
    const auto found = converged(points, search.band, {points.origin, direction, start * rho, 0});
    if (!found) continue;
    const Cylinder at = refineCylinder(points, *found, search.band, workspace);
    if (at.radius < kNearLeast * rho || at.radius > kNearMost * rho) continue;
    if ((points.origin - at.centre).cross(at.axis).norm() > at.radius) continue;
    const double course = 0.5 * (1.0 + std::abs(at.axis.dot(direction)));
    const double score = at.inlierRate * (smooth ? course * radiusLikeness(at.radius, rho) : 1.0);
    if (score <= bestScore) continue;
    bestScore = score;
    best = at;
    if (at.inlierRate >= search.acceptedRate) break;
  }
  return best;
}

}  // namespace lumen::convert
