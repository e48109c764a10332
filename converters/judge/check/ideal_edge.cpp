// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/ideal_edge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "converters/voxels/profile_edge.h"

namespace lumen::convert {
namespace {

constexpr double kRadiusStep = 0.25;  // voxels
constexpr int kRadii = 48;  // up to 12 voxels; beyond, s^2/2R is exact to a hundredth of a voxel
constexpr int kQuadrature = 64;
constexpr double kTail = 5;  // standard deviations, beyond which a Gaussian is negligible

/// A disc of radius `radius` under a Gaussian of standard deviation `s`, at `r` from its centre:
/// the integral over the chords at x, each weighted by the share of the Gaussian along it.
double blurredDisc(double radius, double s, double r) {
  const double low = std::max(-radius, r - kTail * s), high = std::min(radius, r + kTail * s);
  if (low >= high) return 0;
  const double step = (high - low) / kQuadrature;
  double sum = 0;
  for (int i = 0; i < kQuadrature; ++i) {
    const double x = low + (i + 0.5) * step, t = (x - r) / s;
    const double chord = std::sqrt(std::max(radius * radius - x * x, 0.0));
    sum += std::exp(-0.5 * t * t) * std::erf(chord / (std::numbers::sqrt2 * s));
  }
  return sum * step / (s * std::sqrt(2 * std::numbers::pi));
}

/// A ball of radius `radius` under a Gaussian of standard deviation `s`, at `r` from its centre.
double blurredBall(double radius, double s, double r) {
  const double from = std::max(r, 1e-6 * s);  // the limit at the centre
  const double a = (radius - from) / s, b = (radius + from) / s;
  return 0.5 * (std::erf(a / std::numbers::sqrt2) + std::erf(b / std::numbers::sqrt2)) -
         s / (from * std::sqrt(2 * std::numbers::pi)) *
             (std::exp(-0.5 * a * a) - std::exp(-0.5 * b * b));
}

/// Distance, mm, from the wall of the shape to its edge.
template <class Shape>
double displacement(const Shape& shape, double radius, double s, double voxel) {
  const ProfileReach reach = profileReach(radius, voxel);
  const double step = voxel / kSamplesPerVoxel;
  const int inward = static_cast<int>(reach.inward / step);
  const int outward = static_cast<int>(reach.outward / step);
  std::vector<float> values;
  for (int i = -inward; i <= outward; ++i)
    values.push_back(static_cast<float>(shape(radius, s, std::abs(radius + i * step))));
  const ProfileEdge edge = findEdge(values, static_cast<std::size_t>(inward));
  return edge.kind == EdgeKind::Falls ? edge.at * step : 0;
}

}  // namespace

IdealEdge::IdealEdge(double pointSpread, double voxel) : m_sigma(pointSpread), m_voxel(voxel) {
  if (!(pointSpread > 0)) return;
  for (int i = 0; i <= kRadii; ++i) {
    const double radius = std::max(i, 1) * kRadiusStep * voxel;
    m_cylinder.push_back(displacement(blurredDisc, radius, pointSpread, voxel));
    m_ball.push_back(displacement(blurredBall, radius, pointSpread, voxel));
  }
}

double IdealEdge::at(const std::vector<double>& table, double radius, double bends) const {
  if (table.empty()) return 0;
  const double place = radius / (kRadiusStep * m_voxel);
  if (place >= kRadii) return -bends * m_sigma * m_sigma / radius;
  const auto below = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(below);
  return (1 - share) * table[below] + share * table[below + 1];
}

}  // namespace lumen::convert
