// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/seam.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "converters/base/vectors.h"
#include "formats/field/kernel.h"

namespace lumen::convert::fitting {
namespace {

using Eigen::Vector3d;
using formats::Vec3d;

/// Length of a ray, step of its search for the surface, and precision of the result, in wider radii
/// of the two.
constexpr double kLongestRay = 3, kStep = 0.1, kPrecision = 1e-5;
/// Bound on the steps of the root search, which needs far fewer.
constexpr int kRefinements = 40;
/// Share of the narrower radius: surfaces that are farther apart have no common seam.
constexpr double kFarthestApart = 0.5;

/// A ray from a point that is inside.
class Ray {
public:
  Ray(const EnergyParameters& parameters, const Vector3d& origin, const Vector3d& direction,
      double unit)
      : m_parameters(parameters), m_origin(origin), m_direction(direction), m_unit(unit) {}

  /// The first place where the ray leaves the inside of a model.
  [[nodiscard]] std::optional<double> leave(const SeamSide& side) const {
    double low = 0, atLow = excess(side, 0), high = 0, atHigh = atLow;
    if (!(atLow > 0)) return {};
    while (atHigh > 0) {
      low = high;
      atLow = atHigh;
      high += kStep * m_unit;
      if (high > kLongestRay * m_unit) return {};
      atHigh = excess(side, high);
    }
    return bracketed(side, low, atLow, high, atHigh);
  }

private:
  /// Regula falsi with the Illinois rule.
  [[nodiscard]] double bracketed(const SeamSide& side, double low, double atLow, double high,
                                 double atHigh) const {
    int kept = 0;
    for (int i = 0; i < kRefinements && high - low > kPrecision * m_unit; ++i) {
      const double t = (low * atHigh - high * atLow) / (atHigh - atLow), value = excess(side, t);
      if (value > 0) {
        low = t;
        atLow = value;
        if (kept > 0) atHigh *= 0.5;
        kept = 1;
      } else {
        high = t;
        atHigh = value;
        if (kept < 0) atLow *= 0.5;
        kept = -1;
      }
      if (value == 0) break;
    }
    return (low * atHigh - high * atLow) / (atHigh - atLow);
  }

  [[nodiscard]] double excess(const SeamSide& side, double t) const {
    const Vector3d p = m_origin + t * m_direction - toEigen(side.node.centre);
    double f = -m_parameters.isoLevel;
    for (const Blob& blob : side.blobs) {
      const double dx = p.x() - blob.x, dy = p.y() - blob.y, dz = p.z() - blob.z;
      const double x = (dx * dx + dy * dy + dz * dz) / (blob.width * blob.width);
      f += blob.width * field::phi(m_parameters.kernel, m_scale * x);
    }
    return f;
  }

  const EnergyParameters& m_parameters;
  double m_scale = field::chainScale(m_parameters.kernel, m_parameters.kernelParameter);
  Vector3d m_origin, m_direction;
  double m_unit;
};

double power(const FitBall& ball, const Vector3d& p) {
  return (p - toEigen(ball.centre)).squaredNorm() - ball.radius * ball.radius;
}

}  // namespace

std::vector<Vec3d> seamPoints(const EnergyParameters& parameters, const SeamSide& first,
                              const SeamSide& second, std::span<const FitBall> others,
                              double share) {
  std::vector<Vec3d> points;
  const Vector3d from = toEigen(first.node.centre), chord = toEigen(second.node.centre) - from;
  const double distance = chord.norm(), r0 = first.node.radius, r1 = second.node.radius;
  if (!(distance > 0)) return points;
  const Vector3d normal = chord / distance;
  const Vector3d origin = from + 0.5 * (distance + (r0 - r1) * (r0 + r1) / distance) * normal;
  const auto [side, up] = planeBasis(normal);
  const double farthest = kFarthestApart * std::min(r0, r1);
  for (std::size_t i = 0; i < kSeamRays; ++i) {
    const Vector3d direction = ringDirection(i, side, up);
    const Ray ray(parameters, origin, direction, std::max(r0, r1));
    const std::optional<double> a = ray.leave(first);
    if (!a) continue;
    const std::optional<double> b = ray.leave(second);
    if (!b || std::abs(*a - *b) > farthest) continue;
    const Vector3d p = origin + ((1 - share) * *a + share * *b) * direction;
    const double own = power(first.node, p);
    if (std::any_of(others.begin(), others.end(),
                    [&](const FitBall& other) { return power(other, p) < own; })) {
      continue;
    }
    points.push_back(toVec3d(p));
  }
  return points;
}

}  // namespace lumen::convert::fitting
