// SPDX-License-Identifier: Apache-2.0
// The deviation of a surface that lost triangles from the original.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// The greatest distance, mm, between two surfaces, in both directions: at points of each three
/// times as dense as the shorter of both surfaces' edges there, without faces of groups of
/// `isFree`.
double distanceBetween(const TriangleMesh& one, const std::vector<std::uint32_t>& groupOfOne,
                       const TriangleMesh& other, const std::vector<std::uint32_t>& groupOfOther,
                       const std::vector<bool>& isFree);

}  // namespace lumen::convert
