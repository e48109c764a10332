// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/near_cylinder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using NearVector = Eigen::Matrix<double, 5, 1>;
using NearMatrix = Eigen::Matrix<double, 5, 5>;

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
/// Levenberg damping, of the normal matrix' trace.
constexpr double kNearDamping = 1e-9;

struct NearEquations {
  NearMatrix normal = NearMatrix::Zero();
  NearVector right = NearVector::Zero();
  double weights = 0;
};

/// Normal equations for (shift in the plane, tilt, radius) over the candidates, by Tukey's weights.
NearEquations robustEquations(const Candidates& points, const Cylinder& cylinder, double reach) {
  const auto [e1, e2] = planeBasis(cylinder.axis);
  NearEquations out;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Vector3d p = points.origin + points.offset(i) - cylinder.centre;
    const double u = p.dot(e1), v = p.dot(e2), w = p.dot(cylinder.axis);
    const double distance = std::hypot(u, v);
    const double residual = distance - cylinder.radius;
    const double share = residual / reach;
    if (distance == 0 || std::abs(share) >= 1) continue;
    const double weight = (1 - share * share) * (1 - share * share);
    NearVector row;
    row << -u / distance, -v / distance, -w * u / distance, -w * v / distance, -1.0;
    out.normal += weight * row * row.transpose();
    out.right -= weight * residual * row;
    out.weights += weight;
  }
  return out;
}

/// Moves a cylinder by one step; false if too few candidates are near its wall.
bool stepRobustly(const Candidates& points, double reach, const Vector3d& course,
                  Cylinder& cylinder) {
  NearEquations equations = robustEquations(points, cylinder, reach);
  if (equations.weights < static_cast<double>(kFewestCandidates) / 2) return false;
  const auto [e1, e2] = planeBasis(cylinder.axis);
  const double held = kCourseShare * equations.weights * cylinder.radius * cylinder.radius;
  const Vector3d away = course - cylinder.axis;
  equations.normal(2, 2) += held;
  equations.normal(3, 3) += held;
  equations.right[2] += held * away.dot(e1);
  equations.right[3] += held * away.dot(e2);
  equations.normal.diagonal().array() += kNearDamping * equations.normal.trace();
  const NearVector step = equations.normal.ldlt().solve(equations.right);
  if (!step.allFinite()) return false;
  const double most = kMostStep * cylinder.radius;
  const double shift = std::hypot(step[0], step[1]), scale = shift > most ? most / shift : 1;
  cylinder.centre += scale * (step[0] * e1 + step[1] * e2);
  cylinder.axis = (cylinder.axis + scale * (step[2] * e1 + step[3] * e2)).normalized();
  cylinder.radius += std::clamp(step[4], -most, most);
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
