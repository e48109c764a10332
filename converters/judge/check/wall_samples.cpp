// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/wall_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/vectors.h"
#include "converters/geometry/surface_projection.h"

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

}  // namespace lumen::convert
