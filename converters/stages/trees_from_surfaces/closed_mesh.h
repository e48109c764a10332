// SPDX-License-Identifier: Apache-2.0
// A vessel's surface without openings, and its ends.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// A flat end of a vessel: an opening that was closed, or a cap that the surface has.
struct MeshEnd {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< centre of its area, mm
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, out of the vessel
  double radius = 0;                                  ///< radius of the disc of its area, mm
  bool wasOpen = false;
};

/// A surface without boundary. Triangles of `ends` are no wall.
struct ClosedMesh {
  static constexpr std::uint32_t kWall = std::numeric_limits<std::uint32_t>::max();
  TriangleMesh mesh;               ///< mm, LPS, normals outward
  std::vector<std::uint32_t> end;  ///< end of each triangle: index into `ends`, or kWall
  std::vector<MeshEnd> ends;
};

/// Closes `mesh`, which is oriented and manifold, by a fan over each opening, turns its normals
/// outward, and finds its flat ends: the openings, and the parts that are flat, round, and bounded
/// by a sharp edge. The volume that it encloses must not be zero.
ClosedMesh closeMesh(TriangleMesh mesh);

}  // namespace lumen::convert
