// SPDX-License-Identifier: Apache-2.0
// A vessel's surface without openings, and its ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/voxels/volume.h"

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

// The inner side of walls that have a thickness.

/// The inner side of a wall with a thickness whose inner and outer side are one surface: the
/// triangles that face, away from the wall, little but the wall. Oriented out of the lumen, with an
/// opening where the lumen is open; not repaired. Nothing if the surface is not that of such a
/// wall: if less than a quarter of its area faces so, or more than a wall's inner side can have.
/// `tree` is that of `surface`. Throws Error(Cancelled).
std::optional<TriangleMesh> innerSide(const ClosedMesh& surface, const TriangleTree& tree,
                                      const Progress& progress);

/// A mesh without the parts that another one encloses: debris and cavities. An enclosed part that
/// has at least a quarter of the area of the enclosing one is the inner side of a wall, and the
/// outer one is left out instead.
struct UnnestedMesh {
  TriangleMesh mesh;
  std::size_t enclosed = 0;  ///< parts that were left out because another one encloses them
  std::size_t outer = 0;     ///< parts that were left out because they are the outer side of a wall
};
/// The parts of `mesh` are oriented and manifold, closed or open at ends.
UnnestedMesh unnested(TriangleMesh mesh);

// The inside of a closed surface as voxels.

/// The least width of the vessels, mm: the width that all but a fiftieth of their length exceed.
/// `surface` is that of `tree`. Measured by rays from the wall through the lumen; each represents
/// the length of vessel that its triangle goes round.
double leastWidth(const ClosedMesh& surface, const TriangleTree& tree);

/// A grid for the inside of a surface: four voxels to `width`, but at most three hundred thousand
/// inside and 2048 along an axis.
VolumeGeometry insideGrid(const ClosedMesh& surface, double width);

/// The indices (x fastest, ascending) of the voxels of a grid, with the axes of space, whose
/// centres lie inside. Lines of voxels along an axis are followed through the surface; a voxel is
/// inside where the lines of two axes find a winding number of the surface that is not zero, so
/// that the effect of a single fault of the surface on one of them is left out. Throws
/// Error(Cancelled).
std::vector<std::size_t> insideVoxels(const TriangleMesh& mesh, const VolumeGeometry& grid,
                                      const Progress& progress);

}  // namespace lumen::convert
