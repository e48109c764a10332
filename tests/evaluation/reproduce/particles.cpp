// SPDX-License-Identifier: Apache-2.0
#include "particles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace lumen::reproduce {
namespace {

/// Particles by the cube that they are in; a neighbour within a cube's edge is in one of 27.
class Cubes {
public:
  Cubes(const std::vector<Vector3d>& points, double edge) : m_points(points), m_edge(edge) {
    for (std::size_t i = 0; i < points.size(); ++i) m_members[key(index(points[i]))].push_back(i);
  }

  template <class Action>
  void forNear(const Vector3d& p, const Action& action) const {
    const Eigen::Vector3i centre = index(p);
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i cube = centre + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const auto found = m_members.find(key(cube));
      if (found == m_members.end()) continue;
      for (const std::size_t i : found->second) action(m_points[i], i);
    }
  }

private:
  [[nodiscard]] Eigen::Vector3i index(const Vector3d& p) const {
    return (p / m_edge).array().floor().cast<int>();
  }
  static std::int64_t key(const Eigen::Vector3i& cube) {
    constexpr std::int64_t kSpan = 1 << 20;
    return (cube.x() * kSpan + cube.y()) * kSpan + cube.z();
  }

  const std::vector<Vector3d>& m_points;
  double m_edge;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> m_members;
};

/// The mean distance of a point's nearest neighbour.
double spacing(const std::vector<Vector3d>& points) {
  double sum = 0;
  for (const Vector3d& p : points) {
    double least = 1e300;
    for (const Vector3d& q : points) {
      if (&p != &q) least = std::min(least, (p - q).squaredNorm());
    }
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(points.size());
}

/// One step of all particles along the gradient of their repulsion, within the surface.
void repel(const ImplicitSurface& surface, double sigma, double longestStep,
           std::vector<Vector3d>& points) {
  const Cubes cubes(points, 3 * sigma);
  std::vector<Vector3d> moved = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector3d push = Vector3d::Zero();
    cubes.forNear(points[i], [&](const Vector3d& other, std::size_t j) {
      if (i == j) return;
      const Vector3d offset = points[i] - other;
      push += std::exp(-offset.squaredNorm() / (2 * sigma * sigma)) * offset;
    });
    const Vector3d normal = surface.at(points[i]).gradient.normalized();
    push -= normal * normal.dot(push);
    const double length = push.norm();
    if (length > 0.5 * sigma) push *= 0.5 * sigma / length;
    if (const auto p = surface.project(points[i] + push, longestStep)) moved[i] = *p;
  }
  points = std::move(moved);
}

}  // namespace

std::vector<Vector3d> sampleSurface(const ImplicitSurface& surface,
                                    const std::function<Vector3d(Random&)>& seed,
                                    const ParticleOptions& options, Random& random) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < 20 * options.count && points.size() < options.count; ++i) {
    if (const auto p = surface.project(seed(random), options.longestStep)) points.push_back(*p);
  }
  if (points.size() < 2) return points;
  // random points are about half as far from their nearest neighbour as even ones
  const double sigma = 0.6 * 2 * spacing(points);
  for (int round = 0; round < options.rounds; ++round) {
    repel(surface, sigma, options.longestStep, points);
  }
  return points;
}

}  // namespace lumen::reproduce
