// SPDX-License-Identifier: Apache-2.0
// Triangulation of an iso-surface in one cubic cell, for each pattern of inside corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lumen::convert {

/// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge 4 a + k runs along axis a from
/// the k-th corner, ascending, whose bit a is 0.
struct CellEdge {
  std::uint8_t corner = 0;  ///< start
  std::uint8_t axis = 0;
};
constexpr std::array<CellEdge, 12> kCellEdges = [] {
  std::array<CellEdge, 12> edges{};
  std::size_t next = 0;
  for (std::uint8_t axis = 0; axis < 3; ++axis)
    for (std::uint8_t corner = 0; corner < 8; ++corner)
      if ((corner >> axis & 1) == 0) edges[next++] = {corner, axis};
  return edges;
}();

struct CellTriangle {
  std::array<std::uint8_t, 3> edge{};  ///< counter-clockwise seen from outside
  std::uint8_t inside = 0;             ///< an inside corner of the bounded component
};

/// The marching-cubes table, derived and not copied (Lorensen and Cline, 1987, left the ambiguous
/// faces open): on each face every run of outside corners is cut off from the rest, so that inside
/// corners which are diagonal to each other are joined, and two cells always agree about the face
/// between them. The segments link into loops, and each loop is triangulated without a chord in a
/// face of the cell, because the next cell could have the same chord.
class MarchingCubesTable {
public:
  MarchingCubesTable();
  /// Triangles of the case whose inside corners are the set bits.
  [[nodiscard]] std::span<const CellTriangle> triangles(unsigned insideCorners) const {
    return std::span(m_triangles)
        .subspan(m_offset[insideCorners], m_offset[insideCorners + 1] - m_offset[insideCorners]);
  }
  static const MarchingCubesTable& instance();

private:
  std::array<std::uint16_t, 257> m_offset{};
  std::vector<CellTriangle> m_triangles;
};

/// True if both edges lie in one face of the cell.
bool shareFace(unsigned edge, unsigned otherEdge);

}  // namespace lumen::convert
