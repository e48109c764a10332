// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/lattice_vertices.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

using Position = AdaptiveLattice::Position;

Position centreOf(const LatticeCube& cube) {
  const std::int32_t half = cube.size / 2;
  return {cube.corner[0] + half, cube.corner[1] + half, cube.corner[2] + half};
}

Position cornerOf(const LatticeCube& cube, unsigned corner) {
  Position p = cube.corner;
  for (std::size_t a = 0; a < 3; ++a)
    if ((corner >> a & 1U) != 0) p[a] += cube.size;
  return p;
}

Position faceCentre(const LatticeCube& cube, int side) {
  Position p = centreOf(cube);
  p[static_cast<std::size_t>(side / 2)] += side % 2 == 0 ? -cube.size / 2 : cube.size / 2;
  return p;
}

// The four corners of a face, in a circle: bit a of a corner is set where it is greater along axis
// a.
std::array<unsigned, 4> faceCorners(int side) {
  const unsigned axis = static_cast<unsigned>(side) / 2;
  const unsigned u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
  const unsigned base = side % 2 != 0 ? 1U << axis : 0U;
  return {base, base | u, base | u | v, base | v};
}

}  // namespace

std::size_t LatticeVertices::Hash::operator()(const Position& p) const {
  std::uint64_t key = 0;
  for (const std::int32_t c : p) key = key << 20 | static_cast<std::uint64_t>(c);
  return LatticeHash()(key);
}

LatticeVertices::LatticeVertices(const AdaptiveLattice& lattice)
    : m_lattice(lattice), m_index(0, Hash{&m_position}, Same{&m_position}) {
  findNeighbours();
  const std::size_t cubes = lattice.cubes().size();
  m_own.reserve(cubes);
  m_position.reserve(3 * cubes);  // usual, as is the next line
  m_cube.reserve(3 * cubes);
  m_index.reserve(2 * cubes);
  for (std::uint32_t i = 0; i < lattice.cubes().size(); ++i) {
    const LatticeCube& cube = lattice.cubes()[i];
    m_own.push_back({append(centreOf(cube), i), {}});
    for (unsigned c = 0; c < 8; ++c) m_own.back().corner[c] = add(cornerOf(cube, c), i);
    for (int side = 0; side < 6; ++side) {
      const AdaptiveLattice::Neighbour next = m_next[i][static_cast<std::size_t>(side)];
      if (next.kind == AdaptiveLattice::Kind::Coarser) add(faceCentre(cube, side), i);
      if (next.kind != AdaptiveLattice::Kind::None) continue;
      m_isOutermost[add(faceCentre(cube, side), i)] = true;
      for (const unsigned c : faceCorners(side)) m_isOutermost[m_own.back().corner[c]] = true;
    }
  }
}

void LatticeVertices::findNeighbours() {
  m_next.resize(m_lattice.cubes().size());
  tbb::parallel_for(std::size_t{0}, m_next.size(), [&](std::size_t i) {
    for (int side = 0; side < 6; ++side)
      m_next[i][static_cast<std::size_t>(side)] = m_lattice.neighbour(m_lattice.cubes()[i], side);
  });
}

// A cube's tetrahedra have vertices of itself and of cubes that touch it. Two cubes that touch
// share a corner of one of them, since they differ at most by a factor of two.
std::vector<std::uint8_t> LatticeVertices::cubesNear(
    const std::vector<std::uint8_t>& marked) const {
  std::vector<std::uint8_t> holds(m_own.size(), 0), isCorner(size(), 0), isNear(m_own.size(), 0);
  const auto anyCorner = [&](std::size_t cube, const std::vector<std::uint8_t>& of) {
    return std::ranges::any_of(m_own[cube].corner, [&](std::uint32_t v) { return of[v] != 0; });
  };
  // centres of faces are no corners
  for (std::uint32_t v = 0; v < size(); ++v)
    if (marked[v] != 0) holds[m_cube[v]] = 1;
  tbb::parallel_for(std::size_t{0}, holds.size(), [&](std::size_t cube) {
    if (marked[m_own[cube].centre] != 0 || anyCorner(cube, marked)) holds[cube] = 1;
  });
  for (std::size_t cube = 0; cube < holds.size(); ++cube)
    if (holds[cube] != 0)
      for (const std::uint32_t v : m_own[cube].corner) isCorner[v] = 1;
  tbb::parallel_for(std::size_t{0}, isNear.size(),
                    [&](std::size_t cube) { isNear[cube] = anyCorner(cube, isCorner) ? 1 : 0; });
  return isNear;
}

std::uint32_t LatticeVertices::append(const Position& position, std::uint32_t cube) {
  m_position.push_back(position);
  m_cube.push_back(cube);
  m_isOutermost.push_back(false);
  return static_cast<std::uint32_t>(m_position.size() - 1);
}

std::uint32_t LatticeVertices::add(const Position& position, std::uint32_t cube) {
  if (const std::uint32_t known = find(position); known != kNone) return known;
  const std::uint32_t next = append(position, cube);
  m_index.insert(next);
  return next;
}

std::uint32_t LatticeVertices::find(const Position& position) const {
  const auto at = m_index.find(position);
  return at == m_index.end() ? kNone : *at;
}

std::vector<std::uint32_t> LatticeVertices::verticesOf(std::uint32_t cube) const {
  std::vector<std::uint32_t> vertices{m_own[cube].centre};
  vertices.insert(vertices.end(), m_own[cube].corner.begin(), m_own[cube].corner.end());
  return vertices;
}

void LatticeVertices::orient(Tetrahedron& t) const {
  const auto from = [&](std::uint32_t vertex, std::size_t a) {
    return std::int64_t{m_position[vertex][a]} - m_position[t[0]][a];
  };
  std::int64_t m[3][3];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) m[i][a] = from(t[i + 1], a);
  const std::int64_t volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                              m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  if (volume < 0) std::swap(t[2], t[3]);
}

// The vertex in the middle of an edge, which is there if a smaller cube touches the edge.
std::uint32_t LatticeVertices::middleOf(std::uint32_t cube, unsigned from, unsigned to) const {
  const Position p = m_position[m_own[cube].corner[from]], q = m_position[m_own[cube].corner[to]];
  return find({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
}

// Cubes of different sizes share tetrahedra that the smaller one collects; of two equal cubes the
// one at the greater coordinate does.
std::size_t LatticeVertices::collect(std::uint32_t index,
                                     std::array<Tetrahedron, 96>& found) const {
  using Kind = AdaptiveLattice::Kind;
  const LatticeCube& cube = m_lattice.cubes()[index];
  const Own& own = m_own[index];
  std::size_t count = 0;
  const auto emit = [&](Tetrahedron t) {
    orient(t);
    found[count++] = t;
  };
  for (int side = 0; side < 6; ++side) {
    const AdaptiveLattice::Neighbour next = m_next[index][static_cast<std::size_t>(side)];
    if (next.kind == Kind::Finer || (next.kind == Kind::Same && side % 2 != 0)) continue;
    const std::uint32_t other = next.kind == Kind::None ? kNone : m_own[next.cube].centre;
    const std::uint32_t face = next.kind == Kind::Same ? kNone : find(faceCentre(cube, side));
    const auto segment = [&](std::uint32_t from, std::uint32_t to) {
      if (next.kind == Kind::Same) return emit({own.centre, other, from, to});
      emit({own.centre, face, from, to});
      if (other != kNone) emit({other, face, from, to});
    };
    const std::array<unsigned, 4> corners = faceCorners(side);
    for (std::size_t e = 0; e < 4; ++e) {
      const unsigned from = corners[e], to = corners[(e + 1) % 4];
      const std::uint32_t middle = middleOf(index, from, to);
      if (middle == kNone) {
        segment(own.corner[from], own.corner[to]);
      } else {
        segment(own.corner[from], middle);
        segment(middle, own.corner[to]);
      }
    }
  }
  return count;
}

}  // namespace lumen::convert
