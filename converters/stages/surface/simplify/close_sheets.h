// SPDX-License-Identifier: Apache-2.0
// Places of a surface where two parts of it face each other, and crossings there.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/self_intersections.h"

namespace lumen::convert {

/// For each vertex whether another one that is nearer than `reach` of either, by vertex, mm, has a
/// normal against its own: two vessels side by side, the valley of a sharp fork, the two sides of a
/// thin wall; or whether it is at a fold, where triangles around it turn by more than 60 degrees.
std::vector<std::uint8_t> closeVertices(const TriangleMesh& mesh, const std::vector<double>& reach);

/// The pairs of intersecting triangles of which one `isChanged` and both are among `isSearched`, by
/// triangle. Throws Error(Cancelled).
std::vector<std::array<std::uint32_t, 2>> crossingsOfChanged(
    const TriangleMesh& mesh, const std::vector<std::uint8_t>& isChanged,
    const std::vector<std::uint8_t>& isSearched, const Progress& progress);

}  // namespace lumen::convert
