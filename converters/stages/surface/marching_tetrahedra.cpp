// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/marching_tetrahedra.h"

#include <algorithm>

namespace lumen::convert {

SplitEdges::SplitEdges(std::vector<std::pair<std::uint32_t, std::uint32_t>> edges,
                       std::uint32_t firstPoint)
    : m_edge(std::move(edges)), m_first(firstPoint) {
  std::sort(m_edge.begin(), m_edge.end());
  m_edge.erase(std::unique(m_edge.begin(), m_edge.end()), m_edge.end());
}

std::uint32_t SplitEdges::pointOn(std::uint32_t u, std::uint32_t v) const {
  const std::pair<std::uint32_t, std::uint32_t> edge = std::minmax(u, v);
  const auto at = std::lower_bound(m_edge.begin(), m_edge.end(), edge);
  if (at == m_edge.end() || *at != edge) return kNone;
  return m_first + static_cast<std::uint32_t>(at - m_edge.begin());
}

}  // namespace lumen::convert
