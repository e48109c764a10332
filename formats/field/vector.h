// SPDX-License-Identifier: Apache-2.0
// Vectors of three doubles and their operations; standard library only.
#pragma once

#include <cmath>

namespace lumen::field {

struct Vec {
  double x, y, z;
};

inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(double s, const Vec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec& a) {
  return std::sqrt(dot(a, a));
}

/// A unit vector at right angles to `a`, which is not zero.
inline Vec perpendicular(const Vec& a) {
  const double x = std::abs(a.x), y = std::abs(a.y), z = std::abs(a.z);
  const Vec axis = x <= y && x <= z ? Vec{1, 0, 0} : y <= z ? Vec{0, 1, 0} : Vec{0, 0, 1};
  const Vec v = cross(a, axis);
  return (1.0 / norm(v)) * v;
}

/// A symmetric matrix given as xx, yy, zz, xy, xz, yz, times a vector.
inline Vec multiply(const double* h, const Vec& a) {
  return {h[0] * a.x + h[3] * a.y + h[4] * a.z, h[3] * a.x + h[1] * a.y + h[5] * a.z,
          h[4] * a.x + h[5] * a.y + h[2] * a.z};
}

}  // namespace lumen::field
