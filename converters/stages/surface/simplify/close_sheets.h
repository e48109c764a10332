// SPDX-License-Identifier: Apache-2.0
// Places of a surface where two parts of it face each other, and crossings there.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/self_intersections.h"

namespace lumen::convert {

/// For each vertex the distance of the nearest one whose normal is against its own, as a share of the
/// `reach` of either, by vertex, mm: two vessels side by side, the valley of a sharp fork, the two sides
/// of a thin wall; kNotClose beyond the reach; 0 at a fold, where triangles around it turn by more than
/// 60 degrees.
constexpr float kNotClose = 2;
std::vector<float> closeVertices(const TriangleMesh& mesh, const std::vector<double>& reach);

/// The pairs of intersecting triangles of which one `isChanged` and both are among `isSearched`, by
/// triangle. Throws Error(Cancelled).
std::vector<std::array<std::uint32_t, 2>> crossingsOfChanged(
    const TriangleMesh& mesh, const std::vector<std::uint8_t>& isChanged,
    const std::vector<std::uint8_t>& isSearched, const Progress& progress);

}  // namespace lumen::convert
