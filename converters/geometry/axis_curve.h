// SPDX-License-Identifier: Apache-2.0
// The curve of a vessel's axis between two of its nodes.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

/// A place on the axis of a vessel.
struct AxisPoint {
  Eigen::Vector3d position, direction;  ///< mm; unit
  double radius = 0;                    ///< mm
};

/// `count` places between two, which are left out, on the cubic Hermite curve along their
/// directions, at even steps of its parameter. `length`: that of the path between both as far as it
/// is known, mm; at most that of a half circle counts. Radii are interpolated.
std::vector<AxisPoint> curveBetween(const AxisPoint& from, const AxisPoint& to, std::size_t count,
                                    double length);

/// Sum of the angles of the directions at two places with the line from one to the other, radians.
/// The axis of the first place may be followed in either direction. Infinite for equal places.
double turnBetween(const AxisPoint& from, const AxisPoint& to);

}  // namespace lumen::convert
