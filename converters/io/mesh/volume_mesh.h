// SPDX-License-Identifier: Apache-2.0
// The inside of vessels as prisms and tetrahedra, for solvers and for writers of their files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// Stands for no vertex, no cell and no group.
inline constexpr std::uint32_t kAbsent = UINT32_MAX;

/// The corners of a triangle or a quadrilateral, counter-clockwise seen from outside of its cell; the
/// last one of a triangle is kAbsent.
using FaceCorners = std::array<std::uint32_t, 4>;

/// A face of the boundary and its group.
struct BoundaryFace {
  FaceCorners corner{};
  std::uint32_t group = 0;  ///< index into VolumeMesh::groups
};

/// Cells that meet in whole faces. A cell's number is that of its prism, or of its tetrahedron plus
/// the number of prisms.
struct VolumeMesh {
  std::vector<Eigen::Vector3d> position;  ///< mm, LPS
  /// Corners as those of VTK_WEDGE: a triangle that is counter-clockwise seen from outside, on the
  /// wall's side, and the one within, vertex by vertex.
  std::vector<std::array<std::uint32_t, 6>> prism;
  /// Corners as those of VTK_TETRA: the fourth lies where the normal of the first three points to.
  std::vector<std::array<std::uint32_t, 4>> tetrahedron;
  std::vector<BoundaryFace> boundary;
  std::vector<FaceGroup> groups;  ///< those of the surface

  [[nodiscard]] std::size_t cells() const { return prism.size() + tetrahedron.size(); }
};

/// A face between two cells, or one of the boundary.
struct CellFace {
  FaceCorners corner{};               ///< seen from outside of the owner
  std::uint32_t owner = 0;            ///< the cell with the lesser number
  std::uint32_t neighbour = kAbsent;  ///< the other cell
  std::uint32_t group = kAbsent;      ///< of a face of the boundary
};

/// All faces of a mesh: those between two cells, then the boundary's by group; each kind ordered by
/// its owner and neighbour. Throws Error(Failed), with the place, unless each face belongs to two cells that
/// see it from opposite sides or to one cell and one face of the boundary.
std::vector<CellFace> cellFaces(const VolumeMesh& mesh);

/// The corners of the faces of a cell, seen from outside: five of a prism, four of a tetrahedron.
std::vector<FaceCorners> facesOf(const VolumeMesh& mesh, std::size_t cell);

/// The volume of a cell, mm^3, negative if it is turned over. A quadrilateral is the four triangles
/// around the mean of its corners, so volumes of cells add up to what the boundary encloses.
double cellVolume(const VolumeMesh& mesh, std::size_t cell);

/// The scaled Jacobian of a cell: the least volume that three edges of a corner span, over the
/// product of their lengths, 1 for equal edges and for prisms that stand upright on an equilateral
/// triangle, and at most 0 for cells that are turned over (Knupp et al., The Verdict Geometric Quality
/// Library, Sandia, 2006).
double cellQuality(const VolumeMesh& mesh, std::size_t cell);

/// The mesh with each prism divided into three tetrahedra, which meet in whole triangles: the diagonal of
/// a quadrilateral begins at its corner with the least number (Dompierre et al., How to subdivide
/// pyramids, prisms and hexahedra into tetrahedra, 8th International Meshing Roundtable, 1999).
VolumeMesh asTetrahedra(const VolumeMesh& mesh);

/// VTK's XML format: the cells, then the faces of the boundary as cells of their own, as VMTK's meshes
/// have them. `ModelFaceID` and `CellEntityIds` are the number of a face's group, from 1, and 0 for
/// cells of the inside.
std::string encodeVtu(const VolumeMesh& mesh);

}  // namespace lumen::convert
