// SPDX-License-Identifier: Apache-2.0
// Conversions between vectors of a case and Eigen's; directions across an axis.
#pragma once

#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "formats/case/blobby.h"
#include "formats/case/case.h"
#include "formats/view/float3.h"

namespace lumen {

inline Eigen::Vector3d toEigen(const formats::Vec3f& v) {
  return {v.x, v.y, v.z};
}

inline Eigen::Vector3d toEigen(const formats::Vec3d& v) {
  return {v.x, v.y, v.z};
}

inline Eigen::Vector3d toEigen(const formats::Float3& v) {
  return {v[0], v[1], v[2]};
}

inline formats::Vec3f toVec3f(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline formats::Vec3d toVec3d(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Whether all coordinates are numbers of that magnitude or less. Eigen's maxCoeff() may pass over a
/// NaN.
inline bool isWithin(const Eigen::Vector3d& v, double greatest) {
  return (v.array().abs() <= greatest).all();
}

/// Two unit vectors that span the plane normal to the unit vector `axis`; (u, v, axis) is
/// right-handed.
inline std::pair<Eigen::Vector3d, Eigen::Vector3d> planeBasis(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d u = axis.unitOrthogonal();
  return {u, axis.cross(u)};
}

}  // namespace lumen
