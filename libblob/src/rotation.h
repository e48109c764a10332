// SPDX-License-Identifier: Apache-2.0
// Rotations that a pose needs beside those of formats/field/pose.h.
#pragma once

#include <cmath>

#include "formats/field/pose.h"

namespace lumen::blob {

using field::Quaternion;

/// The rotation by b, then by a.
inline Quaternion product(const Quaternion& a, const Quaternion& b) noexcept {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

/// The matrix of a unit quaternion, row by row, times a factor.
template <class T>
void writeMatrix(const Quaternion& q, double factor, T* m) noexcept {
  const double x2 = q[0] + q[0], y2 = q[1] + q[1], z2 = q[2] + q[2];
  const double xx = q[0] * x2, yy = q[1] * y2, zz = q[2] * z2;
  const double xy = q[0] * y2, xz = q[0] * z2, yz = q[1] * z2;
  const double wx = q[3] * x2, wy = q[3] * y2, wz = q[3] * z2;
  const double rows[9] = {1.0 - (yy + zz), xy - wz, xz + wy, xy + wz,        1.0 - (xx + zz),
                          yz - wx,         xz - wy, yz + wx, 1.0 - (xx + yy)};
  for (int i = 0; i < 9; ++i) m[i] = static_cast<T>(factor * rows[i]);
}

/// The least rotation that turns one direction into another, of any lengths; none where one is zero.
/// Between opposite directions it is half a turn about some axis.
inline Quaternion turnBetween(const field::Vec& from, const field::Vec& to) noexcept {
  const double size = field::norm(from) * field::norm(to);
  if (!(size > 0)) return {0, 0, 0, 1};
  const double cosine = field::dot(from, to) / size;
  if (cosine < -1.0 + 1e-12) {
    const field::Vec axis = field::perpendicular(from);
    return {axis.x, axis.y, axis.z, 0};
  }
  const field::Vec axis = (1.0 / size) * field::cross(from, to);
  return field::unit({axis.x, axis.y, axis.z, 1.0 + cosine});
}

}  // namespace lumen::blob
