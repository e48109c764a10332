// SPDX-License-Identifier: Apache-2.0
// Cubes around the wall of a case, small where its vessels are thin.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <tsl/robin_map.h>

#include "converters/base/progress.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

/// A cube of the lattice. Coordinates and sizes are in steps of half the edge of the finest cube,
/// from the lattice's origin, so centres of cubes and of their faces and edges have whole ones.
struct LatticeCube {
  std::array<std::int32_t, 3> corner{};  ///< the corner of least coordinates
  std::int32_t size = 0;
  std::uint32_t node = 0;  ///< node of the tree: a cursor's start for points of the cube
};

/// Spreads keys that are packed coordinates.
struct LatticeHash {
  std::size_t operator()(std::uint64_t key) const {
    key *= 0x9E3779B97F4A7C15ULL;  // golden ratio: D. Knuth, *Sorting and searching*, 6.4
    return key ^ key >> 32;
  }
};

/// The greatest length of cubes' edges near a vessel's wall.
struct LatticeEdge {
  double share = 1;      ///< share of the radius
  SurfaceError allowed;  ///< where chords will be split until they are as near to the field
  /// Edges of that share of the radius, and no more than twice as long as a chord that leaves the
  /// wall by `error`, so that one split of it is enough.
  LatticeEdge(double ofRadius, const SurfaceError& error = {.mm = INFINITY})  // NOLINT: a number
      : share(ofRadius), allowed(error) {}
  /// mm, for a vessel of that radius; grows with it.
  [[nodiscard]] double at(double radius) const {
    return std::min(share * radius, 2 * std::sqrt(8 * allowed.at(radius) * radius));
  }
};

/// The leaves of an octree. Two that share a face, an edge or a corner differ at most by a factor
/// of two.
class AdaptiveLattice {
public:
  using Position = std::array<std::int32_t, 3>;

  /// Cubes that cover the lumen and its surroundings. Near the wall their edges are at most `edge` of
  /// the thinnest vessel there, and at least half of that. Throws Error(InvalidInput) if
  /// the case needs more cubes than fit into memory.
  AdaptiveLattice(const SeparatedField& field, const LatticeEdge& edge, Progress& progress);

  [[nodiscard]] const std::vector<LatticeCube>& cubes() const { return m_cubes; }
  /// mm, LPS.
  [[nodiscard]] Eigen::Vector3d place(const Position& position) const {
    return m_origin + m_step * Eigen::Vector3d(position[0], position[1], position[2]);
  }

  static constexpr std::uint32_t kNone = UINT32_MAX;
  /// The index of the leaf that holds a point, or kNone.
  [[nodiscard]] std::uint32_t cubeAt(const Eigen::Vector3d& point) const;

  enum class Kind : std::uint8_t { None, Same, Coarser, Finer };
  struct Neighbour {
    Kind kind = Kind::None;
    std::uint32_t cube = 0;  ///< where Same or Coarser
  };
  /// The neighbour of a cube beyond its face `side` (0, 1: less, greater x; 2, 3: y; 4, 5: z).
  [[nodiscard]] Neighbour neighbour(const LatticeCube& cube, int side) const;

private:
  friend class LatticeBuilder;
  // A cube of edge 2 << level steps has the key of its corner in units of its size, and its level.
  [[nodiscard]] static std::uint64_t keyOf(const Position& corner, std::int32_t size);

  Eigen::Vector3d m_origin = Eigen::Vector3d::Zero();
  double m_step = 1;  ///< mm
  std::vector<LatticeCube> m_cubes;
  tsl::robin_map<std::uint64_t, std::int32_t, LatticeHash>
      m_index;  ///< index of a leaf, or -1: has children
  std::int32_t m_largest = 2;
};

}  // namespace lumen::convert
