// SPDX-License-Identifier: Apache-2.0
// Rotations, and the frame of a node that moves.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/field/vector.h"

namespace lumen::field {

/// A unit quaternion x, y, z, w.
using Quaternion = std::array<double, 4>;

/// Carries a point X of a node whose centre at rest is O to centre + factor * R (X - O).
struct NodePose {
  Vec centre{0, 0, 0};  ///< mm
  Quaternion rotation{0, 0, 0, 1};
  double factor = 1;
};

inline Quaternion conjugate(const Quaternion& q) {
  return {-q[0], -q[1], -q[2], q[3]};
}

/// `vector` turned by a rotation.
inline Vec rotated(const Quaternion& rotation, const Vec& vector) {
  const Vec axis{rotation[0], rotation[1], rotation[2]};
  const Vec twice = 2.0 * cross(axis, vector);
  return vector + rotation[3] * twice + cross(axis, twice);
}

/// `vector` turned back by a rotation.
inline Vec rotatedBack(const Quaternion& rotation, const Vec& vector) {
  return rotated(conjugate(rotation), vector);
}

/// Position to which a pose carries the point `rest` of a node whose centre at rest is `centre`.
inline Vec carried(const NodePose& pose, const Vec& centre, const Vec& rest) {
  return pose.centre + pose.factor * rotated(pose.rotation, rest - centre);
}

/// Position at rest of a point that the pose has carried to `moved`: the inverse of carried().
inline Vec carriedBack(const NodePose& pose, const Vec& centre, const Vec& moved) {
  return centre + (1.0 / pose.factor) * rotatedBack(pose.rotation, moved - pose.centre);
}

/// The quaternion of length 1 along one that is not zero.
Quaternion unit(Quaternion q);

/// Rotation from `a` to `b` along the shorter arc, at the share `u` of it, 0 to 1.
Quaternion slerp(const Quaternion& a, Quaternion b, double u);

/// Angle in radians, 0 to pi, of the rotation that leads from `a` to `b`.
double angleBetween(const Quaternion& a, const Quaternion& b);

/// Two of a motion's times, and the share of the way from the first to the second.
struct Instant {
  std::size_t from = 0, to = 0;
  double share = 0;
};

/// The instant of a time, s, among ascending times; `period`: s, or 0. See spec/lumen.md, "Between the
/// times".
Instant instantAt(std::span<const double> times, double period, double time);

}  // namespace lumen::field
