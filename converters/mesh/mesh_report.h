// SPDX-License-Identifier: Apache-2.0
// What a triangle mesh is, and what is wrong with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "converters/mesh/repair.h"
#include "converters/mesh/triangle_mesh.h"

namespace lumen::convert {

/// One connected part: triangles that share points.
struct MeshComponent {
  std::size_t vertices = 0, triangles = 0;
  std::size_t boundaryLoops = 0;
  bool closed = false;       ///< no boundary edge
  bool manifold = false;
  bool oriented = false;     ///< neighbours agree
  /// Handles; only of a part that is manifold and oriented. Boundary loops count as filled.
  std::optional<std::int64_t> genus;
  double area = 0, volume = 0;  ///< volume is signed, positive if normals point outward
};

struct MeshReport {
  std::size_t vertices = 0, triangles = 0;
  std::vector<MeshComponent> components;  ///< widest area first
  std::vector<BoundaryLoop> boundaryLoops;
  std::size_t boundaryEdges = 0;
  std::size_t nonManifoldEdges = 0;     ///< of more than two triangles
  std::size_t nonManifoldVertices = 0;  ///< whose triangles are not one fan, without such an edge
  std::size_t misorientedEdges = 0;     ///< whose two triangles run along it the same way
  std::size_t degenerateTriangles = 0;  ///< without area
  std::size_t duplicatePoints = 0, duplicateTriangles = 0, unusedPoints = 0;
  std::size_t selfIntersections = 0;    ///< pairs of triangles that cut each other and share no point
  bool closed = false, manifold = false, oriented = false;
  double area = 0, volume = 0;  ///< of the mesh's unit squared and cubed; volume signed
  Eigen::Vector3d low, high;    ///< the box
};

/// All of that. Points that are equal count as one (see duplicatePoints), so that a soup of
/// triangles is judged as the surface that it is. Throws Error(Cancelled).
MeshReport diagnoseMesh(const TriangleMesh& mesh, const Progress& progress);

/// A unit that makes vessels of a mesh of this size plausible.
struct UnitGuess {
  double millimetres = 1;       ///< in one unit of the mesh: 1, 10 or 1000
  std::string unit = "mm";      ///< "mm", "cm" or "m"
  bool sure = true;             ///< mm is plausible; otherwise announce the guess
};

/// By the vessels' size: twice the volume over the area of a tube is its radius, which is 0.5 to
/// 20 mm of vessels that a mesh is made of, and the box of one is 5 to 1000 mm.
UnitGuess guessUnit(const MeshReport& report);

}  // namespace lumen::convert
