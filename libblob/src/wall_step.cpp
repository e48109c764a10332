// SPDX-License-Identifier: Apache-2.0
#include "wall_step.h"

#include <algorithm>
#include <cmath>

namespace lumen::blob {
namespace {

using field::Vec;

constexpr double kLongestStep = 0.5;   // share of the node's radius
constexpr double kFlat = 0.02;         // least eigenvalue that a step is divided by
constexpr double kLeaveMaximum = 0.1;  // share of the radius: step off a farthest point

// Two directions along the wall, and -|grad f| S in them.
struct TangentPlane {
  explicit TangentPlane(const WallShape& wall)
      : e1(field::perpendicular(wall.normal)), e2(cross(wall.normal, e1)) {
    const Vec h1 = multiply(wall.hessian, e1), h2 = multiply(wall.hessian, e2);
    h11 = dot(e1, h1);
    h12 = dot(e1, h2);
    h22 = dot(e2, h2);
  }
  Vec e1, e2;
  double h11, h12, h22;
};

Vec alongAxis(const Vec& direction, const Vec& toQuery, double eigenvalue,
              const StepBounds& bounds) {
  const double part = dot(direction, toQuery);
  if (eigenvalue < -kFlat && std::abs(part) < bounds.tolerance)
    return (kLeaveMaximum * bounds.radius) * direction;
  return (part / std::max(std::abs(eigenvalue), kFlat)) * direction;
}

}  // namespace

Vec stepDownhill(const WallShape& wall, const StepBounds& bounds) noexcept {
  const TangentPlane plane(wall);
  const double scale = -wall.distance / wall.slope;
  const double a = 1.0 + scale * plane.h11, b = scale * plane.h12, c = 1.0 + scale * plane.h22;
  const double mean = 0.5 * (a + c), half = 0.5 * (a - c), root = std::sqrt(half * half + b * b);
  // cosine and sine of half the angle whose cosine is half / root and whose sine has b's sign
  const double share = root > 0 ? half / root : 1.0;
  const double cosine = std::sqrt(std::max(0.5 * (1.0 + share), 0.0)),
               sine = std::copysign(std::sqrt(std::max(0.5 * (1.0 - share), 0.0)), b);
  const Vec v1 = cosine * plane.e1 + sine * plane.e2;
  const Vec v2 = cosine * plane.e2 - sine * plane.e1;
  const Vec step = alongAxis(v1, wall.toQuery, mean + root, bounds) +
                   alongAxis(v2, wall.toQuery, mean - root, bounds);
  const double length = norm(step), longest = kLongestStep * bounds.radius;
  return length > longest ? (longest / length) * step : step;
}

}  // namespace lumen::blob
