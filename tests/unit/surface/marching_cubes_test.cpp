// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/marching_cubes.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "../mesh/mesh_facts.h"
#include "converters/base/random.h"
#include "converters/geometry/marching_cubes_table.h"

namespace lumen::convert {
namespace {

double straight(const Eigen::Vector3d&, double fa, const Eigen::Vector3d&, double fb) {
  return fa / (fa - fb);
}

SampleGrid cubeGrid(int size, const std::function<double(int, int, int)>& f) {
  SampleGrid grid;
  grid.cell = 1;
  grid.rowsY = grid.rowsZ = size;
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y) {
      grid.rows.push_back({0, size, grid.value.size()});
      for (int x = 0; x < size; ++x) grid.value.push_back(f(x, y, z));
    }
  return grid;
}

// Noise inside, and a shell of outside samples round it.
SampleGrid noise(int size, std::uint64_t seed) {
  Random random(seed);
  return cubeGrid(size, [&](int x, int y, int z) {
    const double value = random.uniform(-1, 1);
    const bool shell = std::min({x, y, z}) == 0 || std::max({x, y, z}) == size - 1;
    return shell ? -1.0 : value;
  });
}

std::vector<SampleState> allInside(const SampleGrid& grid) {
  std::vector<SampleState> state;
  for (const double f : grid.value)
    state.push_back(f > 0 ? SampleState::Inside : SampleState::Outside);
  return state;
}

std::size_t differentCases(const SampleGrid& grid, int size) {
  std::set<unsigned> cases;
  for (int z = 0; z + 1 < size; ++z)
    for (int y = 0; y + 1 < size; ++y)
      for (int x = 0; x + 1 < size; ++x) {
        unsigned inside = 0;
        for (int c = 0; c < 8; ++c) {
          const int at = ((z + (c >> 2)) * size + y + (c >> 1 & 1)) * size + x + (c & 1);
          inside |= static_cast<unsigned>(grid.value[static_cast<std::size_t>(at)] > 0) << c;
        }
        cases.insert(inside);
      }
  return cases.size();
}

TEST(MarchingCubes, NoiseGivesAClosedManifoldAndMeetsAllCases) {
  constexpr int kSize = 24;
  const SampleGrid grid = noise(kSize, 1);
  EXPECT_EQ(differentCases(grid, kSize), 256U);
  const auto state = allInside(grid);
  TriangleMesh patch = marchingCubes(grid, state, straight);
  const test::MeshFacts facts = test::measureFacts(patch);
  EXPECT_EQ(facts.boundaryEdges, 0U);
  EXPECT_EQ(facts.badEdges, 0U);
  EXPECT_GT(facts.volume, 0);
  const std::size_t vertices = patch.position.size();
  separateFans(patch);
  EXPECT_EQ(patch.position.size(), vertices) << "a vertex had more than one fan";
}

TEST(MarchingCubes, OneInsideSampleIsAnOctahedron) {
  const SampleGrid grid =
      cubeGrid(3, [](int x, int y, int z) { return x == 1 && y == 1 && z == 1 ? 1.0 : -1.0; });
  const auto state = allInside(grid);
  const TriangleMesh patch = marchingCubes(grid, state, straight);
  EXPECT_EQ(patch.position.size(), 6U);
  EXPECT_EQ(patch.triangle.size(), 8U);
  // Half-diagonals of 1/2: volume (4/3) a^3 = 1/6.
  EXPECT_NEAR(test::measureFacts(patch).volume, 1.0 / 6, 1e-12);
}

TEST(MarchingCubes, ASurfaceThroughSamplesKeepsItsVerticesApart) {
  const SampleGrid grid = cubeGrid(4, [](int x, int y, int z) {
    return x == 1 && y == 1 && z == 1 ? 1.0 : (x < 3 && y < 3 && z < 3 ? 0.0 : -1.0);
  });
  const auto state = allInside(grid);
  const TriangleMesh patch = marchingCubes(grid, state, straight);
  for (std::size_t a = 0; a < patch.position.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT((patch.position[a] - patch.position[b]).norm(), 1e-5);
}

// Two balls of radius 2 at x = 3 and x = 10.
double twoBalls(int x, int y, int z) {
  const auto ball = [&](int cx) { return 2 - Eigen::Vector3d(x - cx, y - 4, z - 4).norm(); };
  return std::max(ball(3), ball(10));
}

TEST(MarkLumen, KeepsOnlyWhatHangsTogetherWithTheSeed) {
  const SampleGrid grid = cubeGrid(14, twoBalls);
  const auto state = markLumen(grid, 0, {3.2, 4, 4}, 1);
  const TriangleMesh patch = marchingCubes(grid, state, straight);
  const test::MeshFacts facts = test::measureFacts(patch);
  EXPECT_EQ(facts.euler, 2);
  for (const Eigen::Vector3d& p : patch.position) EXPECT_LT(p.x(), 5.5);
  EXPECT_GT(std::count(state.begin(), state.end(), SampleState::OtherInside), 0);
}

TEST(MarkLumen, FindsNothingWhenTheSeedIsTooFarFromTheInside) {
  const SampleGrid grid = cubeGrid(14, twoBalls);
  const auto state = markLumen(grid, 0, {6.5, 4, 4}, 1);
  EXPECT_EQ(std::count(state.begin(), state.end(), SampleState::Inside), 0);
}

TEST(MarkLumen, JoinsAcrossFaceDiagonalsAndNotAcrossTheCell) {
  const auto inside = [](const Eigen::Vector3i& other) {
    const SampleGrid grid = cubeGrid(4, [&](int x, int y, int z) {
      const Eigen::Vector3i at(x, y, z);
      return at == Eigen::Vector3i(1, 1, 1) || at == other ? 1.0 : -1.0;
    });
    const auto state = markLumen(grid, 0, {1, 1, 1}, 0.5);
    return std::count(state.begin(), state.end(), SampleState::Inside);
  };
  for (const Eigen::Vector3i& face :
       {Eigen::Vector3i(2, 2, 1), Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(2, 1, 2),
        Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(1, 2, 2), Eigen::Vector3i(1, 0, 2)})
    EXPECT_EQ(inside(face), 2) << face.transpose();
  EXPECT_EQ(inside({2, 2, 2}), 1);
  EXPECT_EQ(inside({0, 2, 2}), 1);
}

// A noise field's components, marked one seed at a time, are each a closed surface.
TEST(MarkLumen, CutsANoiseFieldIntoClosedSurfaces) {
  const SampleGrid grid = noise(16, 3);
  for (const Eigen::Vector3d& seed : {Eigen::Vector3d(3, 3, 3), Eigen::Vector3d(8, 9, 10)}) {
    const auto state = markLumen(grid, 0.5, seed, 2);
    const test::MeshFacts facts = test::measureFacts(marchingCubes(
        grid, state, [](const Eigen::Vector3d&, double fa, const Eigen::Vector3d&, double fb) {
          return (0.5 - fa) / (fb - fa);
        }));
    EXPECT_GT(facts.area, 0);
    EXPECT_EQ(facts.boundaryEdges, 0U);
    EXPECT_EQ(facts.badEdges, 0U);
  }
}

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
