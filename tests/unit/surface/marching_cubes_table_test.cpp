// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/marching_cubes_table.h"

#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

unsigned endCorner(unsigned edge) {
  return kCellEdges[edge].corner | 1U << kCellEdges[edge].axis;
}

bool crosses(unsigned inside, unsigned edge) {
  return (inside >> kCellEdges[edge].corner & 1) != (inside >> endCorner(edge) & 1);
}

using Chord = std::pair<unsigned, unsigned>;

// Edges of the case's triangles that have no opposite one: the outline on the cell's faces.
std::set<Chord> outline(unsigned inside) {
  std::set<Chord> open;
  for (const CellTriangle& t : MarchingCubesTable::instance().triangles(inside))
    for (std::size_t i = 0; i < 3; ++i) {
      const Chord side{t.edge[i], t.edge[(i + 1) % 3]};
      if (open.erase({side.second, side.first}) == 0) open.insert(side);
    }
  return open;
}

TEST(MarchingCubesTable, OneInsideCornerIsOneTriangleThatFacesAwayFromIt) {
  const auto triangles = MarchingCubesTable::instance().triangles(1);
  ASSERT_EQ(triangles.size(), 1U);
  // Corner 0 is at the origin; its edges along x, y and z are 0, 4 and 8: x to y to z turns left.
  const std::array<std::uint8_t, 3> edge = triangles[0].edge;
  EXPECT_TRUE((edge == std::array<std::uint8_t, 3>{0, 4, 8}) ||
              (edge == std::array<std::uint8_t, 3>{4, 8, 0}) ||
              (edge == std::array<std::uint8_t, 3>{8, 0, 4}));
}

TEST(MarchingCubesTable, UsesEveryCrossingEdgeAndNoOther) {
  for (unsigned inside = 0; inside < 256; ++inside) {
    std::set<unsigned> used, expected;
    for (const CellTriangle& t : MarchingCubesTable::instance().triangles(inside))
      used.insert(t.edge.begin(), t.edge.end());
    for (unsigned e = 0; e < 12; ++e)
      if (crosses(inside, e)) expected.insert(e);
    EXPECT_EQ(used, expected) << "case " << inside;
  }
}

TEST(MarchingCubesTable, HasNoChordInAFace) {
  for (unsigned inside = 0; inside < 256; ++inside) {
    const std::set<Chord> open = outline(inside);
    for (const CellTriangle& t : MarchingCubesTable::instance().triangles(inside))
      for (std::size_t i = 0; i < 3; ++i) {
        const Chord side{t.edge[i], t.edge[(i + 1) % 3]};
        if (!open.contains(side)) {
          EXPECT_FALSE(shareFace(side.first, side.second)) << "case " << inside;
        }
      }
  }
}

// Two cells that meet in a face x = const see the same four corners there, and must draw opposite
// segments.
TEST(MarchingCubesTable, NeighboursAgreeOnTheFaceBetweenThem) {
  constexpr unsigned kHighX = 0xAA;  // corners 1, 3, 5, 7
  const auto segmentsAtX = [](unsigned inside, unsigned x) {
    std::set<Chord> found;
    for (const auto& [a, b] : outline(inside)) {
      const auto onFace = [x](unsigned e) {
        return kCellEdges[e].axis != 0 && (kCellEdges[e].corner & 1U) == x;
      };
      if (onFace(a) && onFace(b)) found.insert({a - x, b - x});
    }
    return found;
  };
  // Edges along y and z start at corners 0, 1, 4, 5 and 0, 1, 2, 3: those at x = 1 come right
  // after.
  for (unsigned inside = 0; inside < 256; ++inside) {
    std::set<Chord> expected;
    for (const auto& [a, b] : segmentsAtX(inside, 1)) expected.insert({b, a});
    for (const unsigned other : {0U, 0xAAU, 0x22U, 0x88U}) {
      const unsigned neighbour = (inside & kHighX) >> 1 | other;
      EXPECT_EQ(segmentsAtX(neighbour, 0), expected) << "case " << inside;
    }
  }
}

TEST(MarchingCubesTable, CornersDiagonalOnAFaceAreJoined) {
  // Corners 0 and 3 lie across the face z = 0: one loop of six edges, so four triangles.
  EXPECT_EQ(MarchingCubesTable::instance().triangles(0b1001).size(), 4U);
  // Corners 0 and 7 lie across the cell: two triangles apart.
  EXPECT_EQ(MarchingCubesTable::instance().triangles(0b10000001).size(), 2U);
}

TEST(MarchingCubesTable, EachTriangleNamesAnInsideCorner) {
  for (unsigned inside = 0; inside < 256; ++inside)
    for (const CellTriangle& t : MarchingCubesTable::instance().triangles(inside))
      EXPECT_TRUE(inside >> t.inside & 1U) << "case " << inside;
}

}  // namespace
}  // namespace lumen::convert
