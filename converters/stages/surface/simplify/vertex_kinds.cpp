// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/vertex_kinds.h"

#include <algorithm>
#include <array>

namespace lumen::convert {
namespace {

constexpr std::uint32_t kNoGroup = UINT32_MAX;

}  // namespace

VertexKinds::VertexKinds(const CaseSurface& surface)
    : m_kind(surface.mesh.position.size(), Movable::Free),
      m_group(surface.mesh.position.size(), kNoGroup),
      m_rimNext(surface.mesh.position.size(), {kNoGroup, kNoGroup}),
      m_rimCount(surface.groups.size(), 0) {
  const std::vector<Triangle>& triangles = surface.mesh.triangle;
  std::vector<std::uint32_t> other(m_kind.size(), kNoGroup);  // a second group
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (const std::uint32_t v : triangles[f]) {
      const std::uint32_t group = surface.group[f];
      if (m_group[v] == kNoGroup || m_group[v] == group) {
        m_group[v] = group;
      } else if (other[v] == kNoGroup || other[v] == group) {
        other[v] = group;
        m_kind[v] = Movable::Rim;
      } else {
        m_kind[v] = Movable::Kept;
      }
    }
  for (std::size_t v = 0; v < m_kind.size(); ++v)
    if (m_kind[v] == Movable::Rim) m_group[v] = std::max(m_group[v], other[v]);
  // A side of the lesser group's triangle and one of the other's make an edge of the rim: the sides
  // of triangles of the other group from a vertex of the rim to one of its.
  std::vector<std::array<std::uint32_t, 2>> rims;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (m_kind[a] == Movable::Free || m_kind[b] == Movable::Free) continue;
      if (surface.group[f] == 0)
        rims.push_back({a, b});
      else
        rims.push_back({b, a});
    }
  }
  std::sort(rims.begin(), rims.end());
  for (std::size_t i = 0; i + 1 < rims.size(); ++i) {
    if (rims[i] != rims[i + 1]) continue;  // a side of each group, in opposite directions
    const auto [a, b] = rims[i];
    m_rimNext[a][1] = b;
    m_rimNext[b][0] = a;
  }
  for (std::size_t v = 0; v < m_kind.size(); ++v) {
    if (m_kind[v] == Movable::Rim && (m_rimNext[v][0] == kNoGroup || m_rimNext[v][1] == kNoGroup))
      m_kind[v] = Movable::Kept;
    if (m_kind[v] != Movable::Free && m_group[v] != kNoGroup) ++m_rimCount[m_group[v]];
  }
}

void VertexKinds::remove(std::uint32_t gone) {
  if (m_kind[gone] != Movable::Rim) return;
  --m_rimCount[m_group[gone]];
  const auto [before, after] = m_rimNext[gone];
  m_rimNext[before][1] = after;
  m_rimNext[after][0] = before;
}

void VertexKinds::restore(std::uint32_t gone) {
  if (m_kind[gone] != Movable::Rim) return;
  ++m_rimCount[m_group[gone]];
  const auto [before, after] = m_rimNext[gone];
  m_rimNext[before][1] = gone;
  m_rimNext[after][0] = gone;
}

}  // namespace lumen::convert
