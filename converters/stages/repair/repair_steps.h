// SPDX-License-Identifier: Apache-2.0
// The steps of repairMesh(), one after the other; each counts its changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/repair/repair.h"

namespace lumen::convert {

/// A mesh under repair.
struct MeshInRepair {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;    ///< for each triangle, as in RepairResult
  std::vector<std::uint32_t> opposite;  ///< as of oppositeSides(), once it is set
  std::vector<std::string> repairs;

  /// Adds "merged 12 duplicate points" to the repairs; nothing if `count` is 0.
  void record(const char* verb, std::size_t count, const char* one, const char* many);
  /// Drops the triangles that `drop` names, and `opposite`.
  std::size_t dropTriangles(const std::vector<bool>& drop);
};

// repair_points.cpp
/// Merges equal points, then those within 1e-6 of the box's diagonal.
void mergePoints(MeshInRepair& work);
/// Drops triangles without area. Where a sliver's middle point lies on the side of a neighbour,
/// that side gets the point. dropDuplicates() drops those with the same points as an earlier one.
void dropDegenerate(MeshInRepair& work);
void dropDuplicates(MeshInRepair& work);
void dropUnusedPoints(MeshInRepair& work);

// repair_sheets.cpp
/// Sets `opposite` across the edges of two triangles, and reverses as few triangles as possible
/// until all neighbours agree; returns their number. Refuses a surface that cannot be oriented.
std::size_t orientSheets(MeshInRepair& work, const std::string& name);
/// Sets `opposite` at edges of more than two triangles: pairs have the inside between them, the
/// other triangles stay open. Returns the number of such edges.
std::size_t cutEdges(MeshInRepair& work);
/// Gives each fan of triangles a point of its own where several meet; returns the number of new
/// points.
std::size_t splitPoints(MeshInRepair& work);

// repair_holes.cpp
/// The boundary loops of a mesh whose points have one fan each, as the triangles run.
std::vector<BoundaryLoop> findBoundaryLoops(const MeshInRepair& work);
/// Sets `centre` and `radius` of a loop.
void measureLoop(const TriangleMesh& mesh, BoundaryLoop& loop);
/// Fills holes; ends of vessels stay open.
void fillHoles(MeshInRepair& work);

// repair_parts.cpp
/// The part of each triangle: triangles joined by `opposite`, numbered from 0 in their order.
std::vector<std::uint32_t> labelParts(const MeshInRepair& work, std::size_t& count);
/// Drops parts that are tiny or enclose nothing, and turns the others outward. Refuses a mesh of
/// which no part is left. Returns the number of parts that are left.
std::size_t settleParts(MeshInRepair& work, const std::string& name);

}  // namespace lumen::convert
