// SPDX-License-Identifier: Apache-2.0
// Linear equations for one step of robust least squares of a cylinder (docs/method.md, section
// 1.13).
#pragma once

#include <optional>

#include <Eigen/Core>

#include "converters/stages/tracking/cylinders/cylinder.h"

namespace lumen::convert {

/// Normal equations of the residuals (distance to the axis - radius, mm) of wall candidates. The five
/// unknowns are the shift of the centre along two directions across the axis, the tilts of the axis
/// towards these, per mm along it, and the radius.
struct CylinderEquations {
  Eigen::Matrix<double, 5, 5> normal;
  Eigen::Matrix<double, 5, 1> right;
  double weights = 0;      ///< sum over the candidates
  Eigen::Vector3d e1, e2;  ///< the directions across the axis, unit

  /// The step that solves the equations, slightly damped, as a short set of candidates leaves the
  /// tilt free; empty if none is finite.
  [[nodiscard]] std::optional<Eigen::Matrix<double, 5, 1>> solve() const;
};

/// Equations of all candidates by Tukey's weights (1 - (residual / reach)^2)^2, and 0 beyond `reach`,
/// mm, and on the axis.
CylinderEquations robustEquations(const Candidates& points, double reach, const Cylinder& cylinder);

// A cylinder through wall candidates next to an expected one, without random numbers
// (docs/method.md, section 1.13).

/// Least and largest radius where the expected one is a depth among voxels, in that one.
constexpr double kLeastOfDepth = 0.5, kMostOfDepth = 1.8;

/// The best cylinder through `points` that holds their origin, of those to which robust least
/// squares lead from the expected axis and a few radii around the expected one, or the first whose
/// rate is accepted: candidates count the less the farther they are off, in a band that narrows to
/// that of the inliers. Scores are those of estimateCylinder(), and the radius is 0.5 to 1.8 times
/// the expected one; the rate is 0, without a radius, if none is valid.
Cylinder nearCylinder(const CylinderSearch& search, const Candidates& points,
                      const ExpectedCylinder& expected, CylinderWorkspace& workspace);

}  // namespace lumen::convert
