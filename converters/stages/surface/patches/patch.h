// SPDX-License-Identifier: Apache-2.0
// A piece of surface while it is being made: plain arrays, before it joins its branch's mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert {

/// The points X with normal . X <= offset; the normal has unit length and points out.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset = 0;
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const {
    return normal.dot(point) - offset;
  }
};

/// Cuts away what lies outside `space`. Triangles that share a cut edge share its new vertex. A
/// vertex closer to the plane than `snap` counts as lying on it, so no sliver thinner than that is
/// left.
void clip(TriangleMesh& patch, const HalfSpace& space, double snap);

/// Drops the connected parts that have no vertex within `distance` of `centre`, mm.
void dropFarParts(TriangleMesh& patch, const Eigen::Vector3d& centre, double distance);

/// Rounds positions to floats, joins the ends of edges that rounding made equal, and drops the
/// triangles that this flattened and the vertices that no triangle uses.
void roundToFloat(TriangleMesh& patch);

/// Gives every vertex but one fan of triangles: where several fans meet in a point, and along edges
/// that have not exactly two opposite triangles, each fan gets a vertex of its own.
void separateFans(TriangleMesh& patch);

// The part of space in which a node draws the wall.

/// The part of space in which a node draws the surface: the intersection of these half-spaces.
struct NodeCell {
  std::vector<HalfSpace> radical;  ///< its power cell
  std::vector<HalfSpace> ends;     ///< where the vessel is cut open
};

/// The cell of `node`. Nothing if it is empty.
///
/// Its power cell is bounded by the radical planes (equal power |X - O|^2 - r^2) to its neighbours,
/// as the blended field has them, that have a model: it is where following a point ends at the
/// node.
///
/// The cell is cut flat at free ends (end_planes.h).
std::optional<NodeCell> nodeCell(const formats::Case& source, const formats::Neighbours& edges,
                                 std::span<const std::uint32_t> neighbours, std::uint32_t node);

}  // namespace lumen::convert
