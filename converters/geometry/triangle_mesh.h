// SPDX-License-Identifier: Apache-2.0
// Triangle mesh for algorithms: doubles and indices only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh, mm, LPS; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> position;
  std::vector<Triangle> triangle;
};

/// A place as files of meshes hold it.
inline Eigen::Vector3d roundedToFloats(const Eigen::Vector3d& place) {
  return place.cast<float>().cast<double>();
}

/// Rounds all positions to floats, so that the mesh has the shape that its file will have: a
/// triangle of a thousandth of a millimetre can be turned over by that.
inline void roundToFloats(TriangleMesh& mesh) {
  for (Eigen::Vector3d& place : mesh.position) place = roundedToFloats(place);
}

}  // namespace lumen::convert
