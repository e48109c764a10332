// SPDX-License-Identifier: Apache-2.0
// The points of an adaptive lattice at which the field is sampled, and the tetrahedra between them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tsl/robin_set.h>

#include "converters/stages/surface/adaptive_lattice.h"

namespace lumen::convert {

/// Corners and centres of cubes, and centres of faces between cubes of two sizes.
///
/// The tetrahedra fill the lattice and meet face to face: a body-centred cubic lattice where cubes
/// have one size; where a cube meets a wider one, both are cones over the fan of triangles around
/// the centre of the face that they share (after F. Labelle and J. Shewchuk, *Isosurface stuffing*,
/// 2007, with another transition).
class LatticeVertices {
public:
  explicit LatticeVertices(const AdaptiveLattice& lattice);

  [[nodiscard]] std::size_t size() const { return m_position.size(); }
  /// mm, LPS.
  [[nodiscard]] Eigen::Vector3d place(std::uint32_t vertex) const {
    return m_lattice.place(m_position[vertex]);
  }
  /// A cube that the vertex belongs to.
  [[nodiscard]] const LatticeCube& cubeOf(std::uint32_t vertex) const {
    return m_lattice.cubes()[m_cube[vertex]];
  }
  /// The centre of a cube, and its corners.
  [[nodiscard]] std::vector<std::uint32_t> verticesOf(std::uint32_t cube) const;
  /// For each cube, whether one of the tetrahedra that it is responsible for may have a vertex that
  /// is marked: 1, or 0 if none has.
  [[nodiscard]] std::vector<std::uint8_t> cubesNear(const std::vector<std::uint8_t>& marked) const;
  /// Whether a vertex lies on the outside of the lattice.
  [[nodiscard]] bool isOutermost(std::uint32_t vertex) const { return m_isOutermost[vertex]; }

  using Tetrahedron = std::array<std::uint32_t, 4>;
  /// Visits the tetrahedra that a cube is responsible for, each once, of positive volume.
  template <class Visit>
  void eachTetrahedron(std::uint32_t cube, Visit&& visit) const {
    std::array<Tetrahedron, 96> found{};
    const std::size_t count = collect(cube, found);
    for (std::size_t i = 0; i < count; ++i) visit(found[i]);
  }

private:
  using Position = AdaptiveLattice::Position;
  static constexpr std::uint32_t kNone = UINT32_MAX;
  /// The vertices of a cube: its centre and its corners.
  struct Own {
    std::uint32_t centre = 0;
    std::array<std::uint32_t, 8> corner{};
  };
  /// Vertices by their places.
  struct Hash {
    const std::vector<Position>* of;
    std::size_t operator()(const Position& p) const;
    std::size_t operator()(std::uint32_t vertex) const { return (*this)((*of)[vertex]); }
  };
  struct Same {
    using is_transparent = void;
    const std::vector<Position>* of;
    bool operator()(std::uint32_t a, std::uint32_t b) const { return (*of)[a] == (*of)[b]; }
    bool operator()(const Position& p, std::uint32_t b) const { return p == (*of)[b]; }
    bool operator()(std::uint32_t a, const Position& p) const { return (*of)[a] == p; }
  };
  void findNeighbours();
  std::uint32_t append(const Position& position, std::uint32_t cube);
  std::uint32_t add(const Position& position, std::uint32_t cube);
  [[nodiscard]] std::uint32_t find(const Position& position) const;
  std::size_t collect(std::uint32_t cube, std::array<Tetrahedron, 96>& found) const;
  [[nodiscard]] std::uint32_t middleOf(std::uint32_t cube, unsigned from, unsigned to) const;
  void orient(Tetrahedron& t) const;

  const AdaptiveLattice& m_lattice;
  /// Neighbours of each cube by its sides.
  std::vector<std::array<AdaptiveLattice::Neighbour, 6>> m_next;
  std::vector<Own> m_own;  ///< vertices of each cube
  std::vector<Position> m_position;
  std::vector<std::uint32_t> m_cube;
  std::vector<bool> m_isOutermost;
  /// All but the centres of cubes, which no other vertex has the place of. Their places are looked up:
  /// with a copy of each the set would take three times the memory.
  tsl::robin_set<std::uint32_t, Hash, Same> m_index;
};

}  // namespace lumen::convert
