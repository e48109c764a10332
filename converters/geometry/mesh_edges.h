// SPDX-License-Identifier: Apache-2.0
// Edges of triangles, for meshes of any quality.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

constexpr std::uint32_t kNoSide = 0xFFFFFFFFU;

/// Side 3t + i of a mesh runs from corner i of triangle t to the next one.
inline std::uint32_t startOf(const std::vector<Triangle>& triangles, std::uint32_t side) {
  return triangles[side / 3][side % 3];
}
inline std::uint32_t endOf(const std::vector<Triangle>& triangles, std::uint32_t side) {
  return triangles[side / 3][(side % 3 + 1) % 3];
}
inline std::uint32_t nextSide(std::uint32_t side) {
  return side % 3 == 2 ? side - 2 : side + 1;
}
inline std::uint32_t previousSide(std::uint32_t side) {
  return side % 3 == 0 ? side + 2 : side - 1;
}

/// One side of a triangle, by its edge.
struct EdgeUse {
  std::uint32_t low, high;  ///< the edge's points, low < high
  std::uint32_t side;
  [[nodiscard]] bool sameEdge(const EdgeUse& other) const {
    return low == other.low && high == other.high;
  }
};

/// Every side; sides of one edge are adjacent, in the order of their triangles. Triangles must have
/// three different points.
std::vector<EdgeUse> edgeUses(const std::vector<Triangle>& triangles);

/// Calls `edge(span of EdgeUse)` for each edge.
template <class Edge>
void forEachEdge(const std::vector<EdgeUse>& uses, Edge edge) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].sameEdge(uses[first])) ++last;
    edge(std::span<const EdgeUse>(uses.data() + first, last - first));
    first = last;
  }
}

/// The opposite side of each side's edge, or kNoSide where an edge has not exactly two sides.
std::vector<std::uint32_t> oppositeSides(const std::vector<Triangle>& triangles);

/// Euler characteristic V - E + F, over the points that triangles use.
std::int64_t eulerCharacteristic(const TriangleMesh& mesh);

/// Points of equal coordinates merged: for each point the first that equals it.
std::vector<std::uint32_t> equalPoints(const std::vector<Eigen::Vector3d>& position);

}  // namespace lumen::convert
