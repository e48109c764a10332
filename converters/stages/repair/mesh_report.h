// SPDX-License-Identifier: Apache-2.0
// Topology, measures and faults of a triangle mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/unit_guess.h"
#include "converters/stages/repair/repair.h"

namespace lumen::convert {

/// One connected part: triangles that share points.
struct MeshComponent {
  std::size_t vertices = 0, triangles = 0;
  std::size_t boundaryLoops = 0, boundaryEdges = 0;
  bool closed = false;  ///< no boundary edge
  bool manifold = false;
  bool oriented = false;  ///< neighbours agree
  /// Handles; only for a part that is manifold and oriented. Boundary loops count as filled.
  std::optional<std::int64_t> genus;
  /// Volume is signed, positive if normals point outward; openings count as closed by fans.
  double area = 0, volume = 0;
};

struct MeshReport {
  std::size_t vertices = 0, triangles = 0;
  std::vector<MeshComponent> components;  ///< widest area first
  std::vector<BoundaryLoop> boundaryLoops;
  std::size_t boundaryEdges = 0;
  std::size_t nonManifoldEdges = 0;     ///< edges of more than two triangles
  std::size_t nonManifoldVertices = 0;  ///< off such edges, with triangles that are not one fan
  std::size_t misorientedEdges = 0;  ///< edges that both triangles run along in the same direction
  std::size_t degenerateTriangles = 0;  ///< triangles without area
  std::size_t duplicatePoints = 0, duplicateTriangles = 0, unusedPoints = 0;
  std::size_t selfIntersections = 0;  ///< pairs of triangles, as selfIntersections() finds them
  bool allSelfIntersections = true;   ///< false: there are more than were counted
  bool closed = false, manifold = false, oriented = false;
  double area = 0, volume = 0;                                ///< sums of the components'
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;  ///< the bounding box
};

/// Topology, measures and faults of a mesh. Equal points count as one (see duplicatePoints), so
/// that a soup of triangles is judged as the surface that it is. Throws Error(Cancelled).
MeshReport diagnoseMesh(const TriangleMesh& mesh, const Progress& progress);

VesselSize vesselSize(const MeshReport& report);

}  // namespace lumen::convert
