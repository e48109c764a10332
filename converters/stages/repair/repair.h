// SPDX-License-Identifier: Apache-2.0
// A triangle mesh made one that algorithms can rely on: oriented, manifold, outward.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

/// A boundary loop of a mesh: vertices one after the other, as the triangles beside it run.
struct BoundaryLoop {
  std::vector<std::uint32_t> vertex;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its length, not of its vertices
  double radius = 0;  ///< mean distance from the centre, along the loop
};

struct RepairResult {
  /// Each connected part is an oriented manifold without degenerate triangles; closed but for
  /// `openings`. Normals point out of what the parts enclose. Unused points are gone.
  TriangleMesh mesh;
  std::vector<std::uint32_t> source;  ///< of each triangle that of the given mesh; kFilled if added
  std::vector<BoundaryLoop> openings;  ///< where vessels end, left open
  std::size_t components = 0;
  std::vector<std::string> repairs;  ///< sentences with counts: "merged 12 duplicate points"
  static constexpr std::uint32_t kFilled = 0xFFFFFFFFU;
};

/// Repairs `mesh`: merges points that are the same or within 1e-6 of the box's diagonal, drops
/// triangles without area or given twice, turns triangles round until neighbours agree and closed parts face
/// outward, splits edges and vertices where more than one sheet meets, drops tiny parts, and fills
/// holes that are not a vessel's end. Throws Error(InvalidInput), `name` (of the file, printable)
/// first, with a sentence and counts for what cannot be repaired: no triangle left, a surface that
/// cannot be oriented, one that encloses nothing.
RepairResult repairMesh(const TriangleMesh& mesh, const std::string& name,
                        const Progress& progress);

}  // namespace lumen::convert
