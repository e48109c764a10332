// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/axis_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumen::convert {

using Eigen::Vector3d;

std::vector<AxisPoint> curveBetween(const AxisPoint& from, const AxisPoint& to, std::size_t count,
                                    double length) {
  const Vector3d across = to.position - from.position;
  const double speed = std::min(length, 0.5 * std::numbers::pi * across.norm());
  const Vector3d first = speed * from.direction, last = speed * to.direction;
  std::vector<AxisPoint> curve;
  for (std::size_t i = 1; i <= count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count + 1), u = 1 - t;
    const Vector3d position = u * u * (1 + 2 * t) * from.position +
                              t * t * (1 + 2 * u) * to.position + t * u * (u * first - t * last);
    const Vector3d tangent = 6 * t * u * across + u * (1 - 3 * t) * first + t * (1 - 3 * u) * last;
    curve.push_back({position, tangent.norm() > 0 ? tangent.normalized() : from.direction,
                     u * from.radius + t * to.radius});
  }
  return curve;
}

double turnBetween(const AxisPoint& from, const AxisPoint& to) {
  const Vector3d chord = to.position - from.position;
  const double distance = chord.norm();
  if (!(distance > 0)) return std::numeric_limits<double>::infinity();
  return std::acos(std::min(1.0, std::abs(from.direction.dot(chord)) / distance)) +
         std::acos(std::clamp(to.direction.dot(chord) / distance, -1.0, 1.0));
}

}  // namespace lumen::convert
