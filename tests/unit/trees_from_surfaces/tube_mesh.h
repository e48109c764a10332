// SPDX-License-Identifier: Apache-2.0
// Surfaces of tubes whose axes and radii are known.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert::test {

/// A tube around a polyline in a plane of constant z, open at both ends or with flat caps; `around` vertices a ring.
inline TriangleMesh tube(const std::vector<Eigen::Vector3d>& axis, double radius, bool hasCaps,
                         std::uint32_t around = 32) {
  using Eigen::Vector3d;
  TriangleMesh mesh;
  const auto rings = static_cast<std::uint32_t>(axis.size());
  for (std::uint32_t i = 0; i < rings; ++i) {
    const Vector3d along =
        (axis[std::min(i + 1, rings - 1)] - axis[i > 0 ? i - 1 : 0]).normalized();
    const Vector3d up = Vector3d::UnitZ(), side = up.cross(along);
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.position.emplace_back(axis[i] +
                                 radius * (std::cos(angle) * side + std::sin(angle) * up));
    }
  }
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = i * around + k, b = i * around + (k + 1) % around;
      mesh.triangle.push_back({a, b, b + around});
      mesh.triangle.push_back({a, b + around, a + around});
    }
  if (!hasCaps) return mesh;
  for (const std::uint32_t ring : {0U, rings - 1}) {
    const auto middle = static_cast<std::uint32_t>(mesh.position.size());
    mesh.position.push_back(axis[ring]);
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = ring * around + k, b = ring * around + (k + 1) % around;
      mesh.triangle.push_back(ring == 0 ? Triangle{b, a, middle} : Triangle{a, b, middle});
    }
  }
  return mesh;
}

/// Along x.
inline std::vector<Eigen::Vector3d> straight(double length, double y = 0, int rings = 60) {
  std::vector<Eigen::Vector3d> axis;
  for (int i = 0; i <= rings; ++i) axis.emplace_back(length * i / rings, y, 0.0);
  return axis;
}

/// A whole circle, its end joined to its start.
inline TriangleMesh ring(double wide, double radius, std::uint32_t rings = 96,
                         std::uint32_t around = 32) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * i / rings;
      const double angle = 2 * std::numbers::pi * k / around;
      const double out = wide + radius * std::cos(angle);
      mesh.position.emplace_back(out * std::cos(turn), out * std::sin(turn),
                                 radius * std::sin(angle));
      const std::uint32_t n = (i + 1) % rings, m = (k + 1) % around;
      mesh.triangle.push_back({i * around + k, n * around + k, n * around + m});
      mesh.triangle.push_back({i * around + k, n * around + m, i * around + m});
    }
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  mesh.position.insert(mesh.position.end(), other.position.begin(), other.position.end());
  for (const Triangle& t : other.triangle)
    mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace lumen::convert::test
