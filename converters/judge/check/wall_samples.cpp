// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/wall_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "converters/base/vectors.h"
#include "converters/geometry/surface_projection.h"
#include "converters/voxels/profile_edge.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr double kFarthest = 3;  // radii: a wall farther out belongs to something else
constexpr int kLeastOnRing = 8, kMostOnRing = 48;
constexpr double kLeastOnSphere = 64, kMostOnSphere = 4096;
const double kGoldenAngle = std::numbers::pi * (3 - std::sqrt(5.0));

}  // namespace

void WallSampler::sample(std::uint32_t node, std::vector<WallSample>& out) const {
  const formats::Branch& branch = m_tree.branches[m_tree.branch[node]];
  if (branch.kind == formats::BranchKind::Aneurysm) {
    sphere(node, out);
    return;
  }
  const Vector3d here = toEigen(m_tree.centre[node]);
  const auto radius = static_cast<double>(m_tree.radius[node]);
  if (branch.nodeCount == 1) ring(node, here, toEigen(m_tree.direction[node]), radius, 0, out);
  if (node == branch.firstNode) return;
  const Vector3d before = toEigen(m_tree.centre[node - 1]), step = here - before;
  const double length = step.norm();
  if (!(length > 0)) return;
  const auto from = static_cast<double>(m_tree.radius[node - 1]);
  const int rings = std::max(1, static_cast<int>(std::lround(length / m_spacing)));
  for (int i = 0; i < rings; ++i) {
    const double share = (i + 0.5) / rings;
    ring(share < 0.5 ? node - 1 : node, before + share * step, step / length,
         from + share * (radius - from), kGoldenAngle * (node + share), out);
  }
}

void WallSampler::ring(std::uint32_t near, const Vector3d& centre, const Vector3d& axis,
                       double radius, double turn, std::vector<WallSample>& out) const {
  const auto [u, v] = planeBasis(axis);
  const double wanted = 2 * std::numbers::pi * radius / m_spacing;
  const int rays = static_cast<int>(std::clamp<double>(wanted, kLeastOnRing, kMostOnRing));
  for (int i = 0; i < rays; ++i) {
    const double angle = turn + 2 * std::numbers::pi * i / rays;
    project(centre, std::cos(angle) * u + std::sin(angle) * v, radius, near, &axis, out);
  }
}

void WallSampler::sphere(std::uint32_t node, std::vector<WallSample>& out) const {
  const auto radius = static_cast<double>(m_tree.radius[node]);
  const double wanted = 4 * std::numbers::pi * radius * radius / (m_spacing * m_spacing);
  const int rays = static_cast<int>(std::clamp(wanted, kLeastOnSphere, kMostOnSphere));
  const Vector3d centre = toEigen(m_tree.centre[node]);
  for (int i = 0; i < rays; ++i) {
    const double z = 1 - (2 * i + 1.0) / rays, r = std::sqrt(1 - z * z);
    const Vector3d ray(r * std::cos(kGoldenAngle * i), r * std::sin(kGoldenAngle * i), z);
    const std::size_t before = out.size();
    project(centre, ray, radius, node, nullptr, out);
    if (out.size() > before && out.back().node != node) out.pop_back();
  }
}

void WallSampler::project(const Vector3d& centre, const Vector3d& ray, double radius,
                          std::uint32_t near, const Vector3d* plane,
                          std::vector<WallSample>& out) const {
  const auto found = projectOnSurface(m_surface, centre + radius * ray, near, radius, plane);
  if (!found || m_tree.branch[found->node] != m_tree.branch[near]) return;
  const double away = (found->position - centre).norm();
  if (away <= kFarthest * radius)
    out.push_back({found->position, -found->gradient.normalized(), found->node, away});
}

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
