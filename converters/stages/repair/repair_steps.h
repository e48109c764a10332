// SPDX-License-Identifier: Apache-2.0
// The steps of repairMesh(), one after the other; each counts what it did.
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
  std::vector<std::uint32_t> source;    ///< of each triangle, as in RepairResult
  std::vector<std::uint32_t> opposite;  ///< as of oppositeSides(), once it is set
  std::vector<std::string> repairs;

  /// "merged 12 duplicate points"; nothing for none.
  void say(const char* verb, std::size_t count, const char* one, const char* many);
  /// Drops the triangles that `drop` names, and `opposite`.
  std::size_t dropTriangles(const std::vector<bool>& drop);
};

// repair_points.cpp
/// Equal points become one, then those within 1e-6 of the box's diagonal.
void mergePoints(MeshInRepair& work);
/// Triangles without area go; where one is a sliver whose middle point lies on the side of a
/// neighbour, that side gets the point. Then those with the same points as one before.
void dropDegenerate(MeshInRepair& work);
void dropDuplicates(MeshInRepair& work);
void dropUnusedPoints(MeshInRepair& work);

// repair_sheets.cpp
/// Sets `opposite` across the edges of two triangles, and turns as few triangles as possible until
/// all neighbours agree; gives their number. Refuses a surface that cannot be oriented.
std::size_t orientSheets(MeshInRepair& work, const std::string& name);
/// Sets `opposite` at edges of more than two triangles: pairs have the inside between them, what is
/// left is open. Gives how many such edges there are.
std::size_t cutEdges(MeshInRepair& work);
/// Points where several fans of triangles meet become one point for each; gives how many were added.
std::size_t splitPoints(MeshInRepair& work);

// repair_holes.cpp
/// The boundary loops of a mesh whose points have one fan each, as the triangles run.
std::vector<BoundaryLoop> boundaryLoopsOf(const MeshInRepair& work);
/// Sets `centre` and `radius` of a loop.
void measureLoop(const TriangleMesh& mesh, BoundaryLoop& loop);
/// Fills holes; ends of vessels stay open.
void fillHoles(MeshInRepair& work);

// repair_parts.cpp
/// For each triangle its part: triangles joined by `opposite`, numbered from 0 in their order.
std::vector<std::uint32_t> partsOf(const MeshInRepair& work, std::size_t& count);
/// Drops parts that are tiny or enclose nothing, and turns the others outward. Refuses what leaves
/// no part. Gives how many are left.
std::size_t settleParts(MeshInRepair& work, const std::string& name);

}  // namespace lumen::convert
