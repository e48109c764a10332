// SPDX-License-Identifier: Apache-2.0
// Small meshes whose measures a person can check.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>

#include "converters/geometry/mesh_measures.h"

namespace lumen::test {

using convert::Triangle;
using convert::TriangleMesh;

/// Volume 1/6, normals outward.
inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// A tube along z from 0 to `length`, `around` points in each of `rings` + 1 rings, open at both
/// ends, normals outward.
inline TriangleMesh openTube(double radius = 1, double length = 10, std::uint32_t around = 16,
                             std::uint32_t rings = 20) {
  TriangleMesh mesh;
  for (std::uint32_t r = 0; r <= rings; ++r)
    for (std::uint32_t a = 0; a < around; ++a) {
      const double angle = 2 * std::numbers::pi * a / around;
      mesh.position.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                 length * r / rings);
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t a = 0; a < around; ++a) {
      const std::uint32_t i = r * around + a, j = r * around + (a + 1) % around;
      mesh.triangle.push_back({i, j, i + around});
      mesh.triangle.push_back({j, j + around, i + around});
    }
  return mesh;
}

/// A ring of `n` quads, closed with a half turn.
inline TriangleMesh moebius(std::uint32_t n = 12) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (const double s : {-0.5, 0.5}) {
      const double a = 2 * std::numbers::pi * i / n;
      const double r = 2 + s * std::cos(a / 2);
      mesh.position.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(a / 2));
    }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    std::uint32_t c = (a + 2) % (2 * n), d = (a + 3) % (2 * n);
    if (i + 1 == n) std::swap(c, d);
    mesh.triangle.push_back({a, c, b});
    mesh.triangle.push_back({b, c, d});
  }
  return mesh;
}

/// A torus of radii 3 and 1 around z, normals outward.
inline TriangleMesh torus(std::uint32_t n = 24, std::uint32_t m = 12) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double r = 3 + std::cos(b);
      mesh.position.emplace_back(r * std::cos(a), r * std::sin(a), std::sin(b));
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const std::uint32_t i2 = (i + 1) % n, j2 = (j + 1) % m;
      mesh.triangle.push_back({i * m + j, i2 * m + j, i2 * m + j2});
      mesh.triangle.push_back({i * m + j, i2 * m + j2, i * m + j2});
    }
  return mesh;
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b,
                           const Eigen::Vector3d& shift = {0, 0, 0}) {
  const auto base = static_cast<std::uint32_t>(a.position.size());
  for (const Eigen::Vector3d& p : b.position) a.position.emplace_back(p + shift);
  for (const Triangle& t : b.triangle)
    a.triangle.push_back({base + t[0], base + t[1], base + t[2]});
  return a;
}

/// Every triangle with points of its own.
inline TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh loose;
  for (const Triangle& t : mesh.triangle) {
    const auto base = static_cast<std::uint32_t>(loose.position.size());
    for (const std::uint32_t v : t) loose.position.emplace_back(mesh.position[v]);
    loose.triangle.push_back({base, base + 1, base + 2});
  }
  return loose;
}

inline void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// A binary STL whose header announces `count` triangles.
inline std::string binaryStl(const TriangleMesh& mesh, std::uint32_t count) {
  std::string bytes(80, ' ');
  append(bytes, count);
  for (const Triangle& t : mesh.triangle) {
    bytes.append(12, '\0');
    for (const std::uint32_t v : t)
      for (const double x : mesh.position[v]) append(bytes, static_cast<float>(x));
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace lumen::test
