// SPDX-License-Identifier: Apache-2.0
// Where a triangle mesh runs through itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_mesh.h"

namespace lumen::convert {

struct SelfIntersections {
  /// Triangles that intersect, the smaller first.
  std::vector<std::array<std::uint32_t, 2>> pairs;
  bool isComplete = true;  ///< false if there are more pairs than the limit
};

/// All pairs of triangles that have more in common than the vertices or the edge that they share by
/// index: that cross, touch, overlap in a plane, or are folded onto one another; of a pair with the
/// same three vertices too. Exact for the given doubles. Triangles without area are left out, and so
/// are those with positions that are not finite or beyond what orientation() takes. At most `limit`
/// pairs, always the same ones, in a fixed order. Throws Error(Cancelled) if `progress`, which may be
/// null, is cancelled.
SelfIntersections selfIntersections(const TriangleMesh& mesh, std::size_t limit = 1'000'000,
                                    const Progress* progress = nullptr);

}  // namespace lumen::convert
