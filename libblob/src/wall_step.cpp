// SPDX-License-Identifier: Apache-2.0
#include "wall_step.h"

#include <algorithm>
#include <cmath>

namespace lumen::blob {
namespace {

using field::Vec;

constexpr double kLongestStep = 0.5;   // share of the node's radius
constexpr double kFlat = 0.02;         // least eigenvalue that a step is divided by
constexpr double kCurved = 0.2;        // least eigenvalue of a step by elimination
constexpr double kDoubted = 0.2;       // eigenvalue that the wall, not one model, may have
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

void bendWall(WallShape& wall, const Vec& move, const Vec& turn) noexcept {
  const double square = dot(move, move);
  if (!(square > 0)) return;
  const double inverse = 1.0 / square;
  const Vec missing = -wall.slope * turn - multiply(wall.hessian, move);
  const Vec r = inverse * (missing - (0.5 * inverse * dot(missing, move)) * move);
  double* h = wall.hessian;
  h[0] += 2.0 * r.x * move.x;
  h[1] += 2.0 * r.y * move.y;
  h[2] += 2.0 * r.z * move.z;
  h[3] += r.x * move.y + move.x * r.y;
  h[4] += r.x * move.z + move.x * r.z;
  h[5] += r.y * move.z + move.y * r.z;
}

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

WallStep stepAlongWall(const WallShape& wall, const StepBounds& bounds) noexcept {
  const TangentPlane plane(wall);
  const double scale = -1.0 / wall.slope;
  const double s11 = scale * plane.h11, s12 = scale * plane.h12, s22 = scale * plane.h22;
  const double a = 1.0 + wall.distance * s11, b = wall.distance * s12,
               c = 1.0 + wall.distance * s22;
  const double t1 = dot(plane.e1, wall.toQuery), t2 = dot(plane.e2, wall.toQuery);
  double x, y;
  if (a > kCurved && (a - kCurved) * (c - kCurved) > b * b) {
    const double inverse = 1.0 / (a * c - b * b);
    x = inverse * (c * t1 - b * t2);
    y = inverse * (a * t2 - b * t1);
  } else {
    const Vec step = stepDownhill(wall, bounds);
    x = dot(plane.e1, step);
    y = dot(plane.e2, step);
  }
  const double length = std::sqrt(x * x + y * y), longest = kLongestStep * bounds.radius;
  const double share = length > longest ? longest / length : 1.0;
  x *= share;
  y *= share;
  const double sag = 0.5 * (s11 * x * x + 2.0 * s12 * x * y + s22 * y * y);
  const double gain = std::max(0.5 * (x * t1 + y * t2), 0.5 / kDoubted * (t1 * t1 + t2 * t2));
  return {x * plane.e1 + y * plane.e2, share * length, sag, gain};
}

}  // namespace lumen::blob
