// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/marching_cubes_table.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lumen::convert {
namespace {

using Loop = std::vector<std::uint8_t>;  // edges
constexpr std::uint8_t kNoEdge = 255;

std::uint8_t edgeBetween(unsigned corner, unsigned otherCorner) {
  const unsigned low = std::min(corner, otherCorner), axisBit = corner ^ otherCorner;
  for (std::uint8_t e = 0; e < kCellEdges.size(); ++e)
    if (kCellEdges[e].corner == low && 1U << kCellEdges[e].axis == axisBit) return e;
  return kNoEdge;
}

// The corners of a face, counter-clockwise seen from outside the cell.
std::array<unsigned, 4> faceCorners(unsigned axis, bool high) {
  const unsigned u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
  const unsigned base = high ? 1U << axis : 0U;
  if (high) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

// A walk round a face leaves the inside at an exit and returns at an entry. A loop runs from each
// entry to the exit before it, with the outside corners between on its right as seen from outside
// the cell.
std::array<std::uint8_t, 12> linkSegments(unsigned inside) {
  std::array<std::uint8_t, 12> next;
  next.fill(kNoEdge);
  for (unsigned face = 0; face < 6; ++face) {
    const auto corner = faceCorners(face / 2, face % 2 == 1);
    const auto isInside = [&](unsigned i) { return (inside >> corner[i % 4] & 1) != 0; };
    for (unsigned i = 0; i < 4; ++i) {
      if (!isInside(i) || isInside(i + 1)) continue;
      unsigned entry = i + 1;
      while (!isInside(entry + 1)) ++entry;
      next[edgeBetween(corner[entry % 4], corner[(entry + 1) % 4])] =
          edgeBetween(corner[i], corner[(i + 1) % 4]);
    }
  }
  return next;
}

// The best triangulation of the sub-polygon loop[first .. last]: fewest chords in faces, then the
// lowest apex.
int triangulate(const Loop& loop, std::size_t first, std::size_t last,
                std::vector<CellTriangle>& out) {
  if (last < first + 2) return 0;
  int best = std::numeric_limits<int>::max();
  std::vector<CellTriangle> bestTriangles;
  const auto chordCost = [&](std::size_t a, std::size_t b) {
    const bool isChord = b - a > 1 && b - a < loop.size() - 1;
    return isChord && shareFace(loop[a], loop[b]) ? 1 : 0;
  };
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    std::vector<CellTriangle> triangles{{{loop[first], loop[apex], loop[last]}, 0}};
    const int cost = chordCost(first, apex) + chordCost(apex, last) +
                     triangulate(loop, first, apex, triangles) +
                     triangulate(loop, apex, last, triangles);
    if (cost < best) {
      best = cost;
      bestTriangles = std::move(triangles);
    }
  }
  out.insert(out.end(), bestTriangles.begin(), bestTriangles.end());
  return best;
}

std::uint8_t insideEnd(std::uint8_t edge, unsigned inside) {
  const CellEdge e = kCellEdges[edge];
  const auto end = static_cast<std::uint8_t>(e.corner | 1U << e.axis);
  return (inside >> e.corner & 1) != 0 ? e.corner : end;
}

std::vector<CellTriangle> makeTriangles(unsigned inside) {
  std::vector<CellTriangle> result;
  auto next = linkSegments(inside);
  for (std::uint8_t start = 0; start < next.size(); ++start) {
    Loop loop;
    for (std::uint8_t e = start; next[e] != kNoEdge;) {
      loop.push_back(e);
      e = std::exchange(next[e], kNoEdge);
    }
    if (loop.empty()) continue;
    std::vector<CellTriangle> triangles;
    triangulate(loop, 0, loop.size() - 1, triangles);
    for (CellTriangle& t : triangles) t.inside = insideEnd(start, inside);
    result.insert(result.end(), triangles.begin(), triangles.end());
  }
  return result;
}

}  // namespace

bool shareFace(unsigned edge, unsigned otherEdge) {
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned high = 0; high < 2; ++high) {
      const auto onFace = [&](unsigned e) {
        return kCellEdges[e].axis != axis && (kCellEdges[e].corner >> axis & 1U) == high;
      };
      if (onFace(edge) && onFace(otherEdge)) return true;
    }
  return false;
}

MarchingCubesTable::MarchingCubesTable() {
  for (unsigned inside = 0; inside < 256; ++inside) {
    const auto triangles = makeTriangles(inside);
    m_triangles.insert(m_triangles.end(), triangles.begin(), triangles.end());
    m_offset[inside + 1] = static_cast<std::uint16_t>(m_triangles.size());
  }
}

const MarchingCubesTable& MarchingCubesTable::instance() {
  static const MarchingCubesTable table;
  return table;
}

}  // namespace lumen::convert
