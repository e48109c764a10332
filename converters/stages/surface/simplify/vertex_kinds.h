// SPDX-License-Identifier: Apache-2.0
// Vertices of a surface by how they may move during simplification.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/stages/surface/case_surface.h"

namespace lumen::convert {

enum class Movable : std::uint8_t {
  Free,  ///< all triangles around are of one group
  Rim,   ///< between two groups: moves along their rim only
  Kept   ///< does not go
};

/// The kinds of a surface's vertices, and the rims between its groups.
class VertexKinds {
public:
  explicit VertexKinds(const CaseSurface& surface);

  [[nodiscard]] Movable kind(std::uint32_t v) const { return m_kind[v]; }
  /// The group of a free vertex; that of the wall for others.
  [[nodiscard]] std::uint32_t groupOf(std::uint32_t v) const {
    return m_kind[v] == Movable::Free ? m_group[v] : 0;
  }
  /// Whether a collapse of the edge from `gone` to `kept` keeps rims where they are.
  [[nodiscard]] bool mayMove(std::uint32_t gone, std::uint32_t kept) const {
    if (m_kind[gone] == Movable::Free) return true;
    return m_kind[gone] == Movable::Rim && m_kind[kept] != Movable::Free &&
           (m_rimNext[gone][0] == kept || m_rimNext[gone][1] == kept);
  }
  /// Whether the vertex is of a rim of no more than `least` edges.
  [[nodiscard]] bool isRimShort(std::uint32_t gone, std::size_t least) const {
    return m_kind[gone] == Movable::Rim && m_rimCount[m_group[gone]] <= least;
  }
  /// A vertex that may move has gone.
  void remove(std::uint32_t gone);
  /// It is back; its neighbours along the rim are those of then.
  void restore(std::uint32_t gone);

private:
  std::vector<Movable> m_kind;
  std::vector<std::uint32_t> m_group;  ///< of a rim's vertex: the group that is not the wall
  std::vector<std::array<std::uint32_t, 2>> m_rimNext;  ///< neighbours along the rim
  std::vector<std::size_t> m_rimCount;                  ///< by group
};

}  // namespace lumen::convert
