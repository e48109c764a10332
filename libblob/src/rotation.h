// SPDX-License-Identifier: Apache-2.0
// Rotations as unit quaternions x, y, z, w.
#pragma once

#include <cmath>

#include "formats/field/vector.h"

namespace lumen::blob {

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};

inline double dot(const Quaternion& a, const Quaternion& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

inline Quaternion scaled(const Quaternion& q, double s) noexcept {
  return {s * q.x, s * q.y, s * q.z, s * q.w};
}

inline Quaternion normalised(const Quaternion& q) noexcept {
  return scaled(q, 1.0 / std::sqrt(dot(q, q)));
}

inline Quaternion conjugate(const Quaternion& q) noexcept {
  return {-q.x, -q.y, -q.z, q.w};
}

/// The rotation by b, then by a.
inline Quaternion operator*(const Quaternion& a, const Quaternion& b) noexcept {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The matrix of a unit quaternion, row by row, times a factor.
template <class T>
void writeMatrix(const Quaternion& q, double factor, T* m) noexcept {
  const double x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const double xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
  const double xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const double wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  const double rows[9] = {1.0 - (yy + zz), xy - wz, xz + wy, xy + wz,        1.0 - (xx + zz),
                          yz - wx,         xz - wy, yz + wx, 1.0 - (xx + yy)};
  for (int i = 0; i < 9; ++i) m[i] = static_cast<T>(factor * rows[i]);
}

inline field::Vec rotate(const Quaternion& q, const field::Vec& v) noexcept {
  const field::Vec axis{q.x, q.y, q.z}, t = 2.0 * field::cross(axis, v);
  return v + q.w * t + field::cross(axis, t);
}

/// The least rotation that turns one direction into another, of any lengths; none where one is zero.
/// Of opposite directions, it is half a turn about some axis.
inline Quaternion turnBetween(const field::Vec& from, const field::Vec& to) noexcept {
  const double size = field::norm(from) * field::norm(to);
  if (!(size > 0)) return {};
  const double cosine = field::dot(from, to) / size;
  if (cosine < -1.0 + 1e-12) {
    const field::Vec axis = field::perpendicular(from);
    return {axis.x, axis.y, axis.z, 0};
  }
  const field::Vec axis = (1.0 / size) * field::cross(from, to);
  return normalised({axis.x, axis.y, axis.z, 1.0 + cosine});
}

/// Slerp from one rotation to another along the shorter arc.
inline Quaternion between(const Quaternion& from, Quaternion to, double t) noexcept {
  double cosine = dot(from, to);
  if (cosine < 0) {
    to = scaled(to, -1.0);
    cosine = -cosine;
  }
  double a = 1.0 - t, b = t;
  if (cosine < 1.0 - 1e-9) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    a = std::sin(a * angle) / sine;
    b = std::sin(b * angle) / sine;
  }
  return normalised(
      {a * from.x + b * to.x, a * from.y + b * to.y, a * from.z + b * to.z, a * from.w + b * to.w});
}

}  // namespace lumen::blob
