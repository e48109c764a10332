// SPDX-License-Identifier: Apache-2.0
// Areas, volumes and boxes of triangle meshes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box.h"

namespace lumen::convert {

// Triangle mesh for algorithms: doubles and indices only.

using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh, mm, LPS; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> position;
  std::vector<Triangle> triangle;
};

/// The float next to a number. Debian 12's gcc (12.2, from -O2 on) takes neither of the two conversions
/// of numbers side by side, so each float lies in memory between them.
inline double roundedToFloat(double number) {
  const volatile float rounded = static_cast<float>(number);
  return static_cast<double>(rounded);
}

/// A place as files of meshes hold it.
inline Eigen::Vector3d roundedToFloats(const Eigen::Vector3d& place) {
  return {roundedToFloat(place.x()), roundedToFloat(place.y()), roundedToFloat(place.z())};
}

/// Rounds all positions to floats, so that the mesh has the shape that its file will have: a
/// triangle of a thousandth of a millimetre can be turned over by that.
inline void roundToFloats(TriangleMesh& mesh) {
  for (Eigen::Vector3d& place : mesh.position) place = roundedToFloats(place);
}

/// The vector area of a triangle: its normal times its area.
inline Eigen::Vector3d vectorArea(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d& a = mesh.position[t[0]];
  const Eigen::Vector3d u = mesh.position[t[1]] - a, v = mesh.position[t[2]] - a;
  return 0.5 * Eigen::Vector3d(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                               u.x() * v.y() - u.y() * v.x());
}

/// True for a triangle whose height is below 1e-6 of its longest side: its normal is only rounding
/// error.
bool isDegenerate(const TriangleMesh& mesh, const Triangle& t);

/// The volume of a tetrahedron with a corner at the origin; positive if a, b, c run
/// counter-clockwise seen from outside.
inline double tetrahedronVolume(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d across(b.y() * c.z() - b.z() * c.y(), b.z() * c.x() - b.x() * c.z(),
                               b.x() * c.y() - b.y() * c.x());
  return a.dot(across) / 6;
}

/// The volume that a mesh without boundary encloses; negative if its normals point inwards.
double signedVolume(const TriangleMesh& mesh);

/// The box of the points that triangles use; the origin alone if there are no triangles.
Box3d boundingBox(const TriangleMesh& mesh);

}  // namespace lumen::convert
