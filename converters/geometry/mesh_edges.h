// SPDX-License-Identifier: Apache-2.0
// The edges of triangles, whatever state their mesh is in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/geometry/triangle_mesh.h"

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

/// One triangle's side, by its edge.
struct EdgeUse {
  std::uint32_t low, high;  ///< the edge's points, low < high
  std::uint32_t side;
  [[nodiscard]] bool sameEdge(const EdgeUse& other) const {
    return low == other.low && high == other.high;
  }
};

/// Every side, so that those of one edge follow one another in the order of their triangles.
/// Triangles must have three different points.
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

/// The other side of each side's edge, or kNoSide where an edge has not two sides.
std::vector<std::uint32_t> oppositeSides(const std::vector<Triangle>& triangles);

/// V - E + F, of the points that triangles use.
std::int64_t eulerCharacteristic(const TriangleMesh& mesh);

/// Points of equal coordinates made one: for each point the first that equals it.
std::vector<std::uint32_t> equalPoints(const std::vector<Eigen::Vector3d>& position);

}  // namespace lumen::convert
