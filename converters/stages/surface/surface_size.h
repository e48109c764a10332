// SPDX-License-Identifier: Apache-2.0
// Estimates of the size of the surface of a case.
#pragma once

#include <optional>

#include "converters/stages/surface/length.h"
#include "converters/stages/surface/remesh_target.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Triangles that a surface may have, and the memory that one takes while it is made.
constexpr double kMaxSurfaceTriangles = 1 << 24, kBytesPerTriangle = 400;

/// The approximate number of triangles of the surface of a tree, with an outer surface if there is
/// a wall of that thickness. O(nodes).
double expectedTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness);

/// Throws Error(InvalidInput) if more than kMaxSurfaceTriangles are to be expected; the sentence
/// states the numbers, and an edge or a thickness that is enough.
void requireFewTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness);

}  // namespace lumen::convert
