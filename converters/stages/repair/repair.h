// SPDX-License-Identifier: Apache-2.0
// Repair of a triangle mesh, so that algorithms can rely on it: oriented, manifold, outward.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// A boundary loop of a mesh: vertices one after the other, as the triangles beside it run.
struct BoundaryLoop {
  std::vector<std::uint32_t> vertex;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of its length, not of its vertices
  double radius = 0;  ///< mean distance from the centre, along the loop
};

struct RepairResult {
  /// Each connected part is an oriented manifold without degenerate triangles; closed but for
  /// `openings`. Normals point out of the enclosed volume. Unused points are dropped.
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;   ///< for each triangle the given one; kFilled if added
  std::vector<BoundaryLoop> openings;  ///< where vessels end, left open
  std::size_t components = 0;
  std::vector<std::string> repairs;  ///< sentences with counts: "merged 12 duplicate points"
  static constexpr std::uint32_t kFilled = 0xFFFFFFFFU;
};

/// Repairs `mesh`: merges points that are equal or within 1e-6 of the box's diagonal, drops
/// triangles that are duplicates or have no area, reverses triangles until neighbours agree and
/// closed parts face outward, splits edges and vertices where more than one sheet meets, drops tiny
/// parts, and fills holes that are not a vessel's end. Throws Error(InvalidInput), `name` (of the
/// file, printable) first, with a sentence and counts for a mesh that cannot be repaired: no
/// triangle left, a surface that cannot be oriented, one that encloses nothing.
RepairResult repairMesh(const TriangleMesh& mesh, const std::string& name,
                        const Progress& progress);

}  // namespace lumen::convert
