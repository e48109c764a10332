// SPDX-License-Identifier: Apache-2.0
// The surface of a case while it is being made.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/geometry/mesh_measures.h"
#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// A place where the surface was cut flat, or closes as the field closes it.
struct SurfaceEnd {
  std::uint32_t group = 0;   ///< group of the faces that close it: index into CaseSurface::groups
  std::uint32_t branch = 0;  ///< index into the tree's branches
  std::uint32_t node = 0;    ///< the first or last node of that branch
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the plane, on the axis, mm
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, out of the vessel, along its axis
};

/// Closed, oriented 2-manifolds, one for each connected tree. Group 0 is the wall. Edges between
/// two groups are the rims of ends; vertices all of whose triangles are of a flat group lie in
/// that end's plane.
struct CaseSurface {
  TriangleMesh mesh;
  std::vector<std::uint32_t> node;   ///< for each vertex the node of a cursor there
  std::vector<std::uint32_t> group;  ///< group of each triangle: index into `groups`
  std::vector<FaceGroup> groups;
  std::vector<SurfaceEnd> ends;  ///< in the order of their groups
};

}  // namespace lumen::convert
