// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/simplify/collapsing_mesh.h"

#include <algorithm>
#include <array>

#include "converters/stages/surface/simplify/close_sheets.h"

namespace lumen::convert {

CollapsingMesh::CollapsingMesh(CaseSurface& surface, const std::vector<float>& closeFrom)
    : m_surface(surface),
      m_place(surface.mesh.position),
      m_triangle(surface.mesh.triangle),
      m_closeFrom(closeFrom),
      m_isCloseTriangle(m_triangle.size(), 1),
      m_kinds(surface),
      m_nextGone(m_place.size(), kNone),
      m_firstGone(m_triangle.size(), kNone) {
  lookWithin(1);
}

void CollapsingMesh::lookWithin(double share) {
  m_share = share;
  for (std::size_t f = 0; f < m_triangle.size(); ++f) {
    m_isCloseTriangle[f] = hasCloseCorner(m_triangle[f]);
    for (std::uint32_t v = m_firstGone[f]; v != kNone; v = m_nextGone[v])
      m_isCloseTriangle[f] |= isCloseVertex(v);
  }
}

std::uint8_t CollapsingMesh::hasCloseCorner(const Triangle& t) const {
  return isCloseVertex(t[0]) | isCloseVertex(t[1]) | isCloseVertex(t[2]);
}

void CollapsingMesh::beginPass() {
  m_offset.assign(m_place.size() + 1, 0);
  for (const Triangle& t : m_triangle)
    for (const std::uint32_t v : t) ++m_offset[v + 1];
  for (std::size_t v = 0; v < m_place.size(); ++v) m_offset[v + 1] += m_offset[v];
  m_fan.resize(3 * m_triangle.size());
  m_at.assign(m_offset.begin(), m_offset.end() - 1);
  for (std::uint32_t f = 0; f < m_triangle.size(); ++f)
    for (const std::uint32_t v : m_triangle[f]) m_fan[m_at[v]++] = f;
  m_isTouched.assign(m_place.size(), 0);
  m_isDropped.assign(m_triangle.size(), 0);
  m_collapses.clear();
  m_before.clear();
  m_goneBefore.clear();
}

void CollapsingMesh::setGone(const GoneVertex& gone) {
  m_nextGone[gone.vertex] = m_firstGone[gone.triangle];
  m_firstGone[gone.triangle] = gone.vertex;
}

void CollapsingMesh::collapse(std::uint32_t gone, std::uint32_t kept,
                              const std::vector<ChangedTriangle>& after,
                              const std::vector<GoneVertex>& taken) {
  m_collapses.push_back({gone, kept, m_before.size(), m_goneBefore.size()});
  std::uint8_t wasClose = 0;
  for (const std::uint32_t f : fan(gone)) {
    m_before.push_back({f, m_triangle[f]});
    for (std::uint32_t v = m_firstGone[f]; v != kNone; v = m_nextGone[v])
      m_goneBefore.push_back({v, f});
    m_firstGone[f] = kNone;
    m_isDropped[f] = 1;
    wasClose |= m_isCloseTriangle[f];
    for (const std::uint32_t v : m_triangle[f]) m_isTouched[v] = 1;
  }
  for (const auto& [f, t] : after) {
    m_triangle[f] = t;
    m_isDropped[f] = 0;
    m_isCloseTriangle[f] = taken.empty() ? wasClose : hasCloseCorner(t);
  }
  for (const GoneVertex& v : taken) {
    setGone(v);
    m_isCloseTriangle[v.triangle] |= isCloseVertex(v.vertex);
  }
  m_kinds.remove(gone);
}

std::span<const GoneVertex> CollapsingMesh::goneBefore(const Collapse& collapse) const {
  const std::size_t next = static_cast<std::size_t>(&collapse - m_collapses.data()) + 1;
  const std::size_t end =
      next < m_collapses.size() ? m_collapses[next].firstGone : m_goneBefore.size();
  return std::span(m_goneBefore).subspan(collapse.firstGone, end - collapse.firstGone);
}

void CollapsingMesh::undo(Collapse& collapse) {
  collapse.isUndone = true;
  for (const auto& [f, t] : before(collapse)) {
    m_triangle[f] = t;
    m_isDropped[f] = 0;
    m_firstGone[f] = kNone;
    m_isCloseTriangle[f] = 1;
  }
  for (const GoneVertex& v : goneBefore(collapse)) setGone(v);
  m_kinds.restore(collapse.gone);
}

void CollapsingMesh::undoCrossings(const Progress& progress) {
  std::vector<std::uint32_t> by(m_triangle.size(), kNone);  // the collapse that changed a triangle
  std::vector<std::uint8_t> isChanged(m_triangle.size(), 0), isSearched(m_triangle.size());
  for (std::uint32_t c = 0; c < m_collapses.size(); ++c)
    for (const auto& [f, t] : before(m_collapses[c])) {
      by[f] = c;
      isChanged[f] = m_isDropped[f] == 0 ? 1 : 0;
    }
  while (true) {
    for (std::size_t f = 0; f < isSearched.size(); ++f)
      isSearched[f] = m_isDropped[f] == 0 ? m_isCloseTriangle[f] : 0;
    const auto crossings = crossingsOfChanged(m_surface.mesh, isChanged, isSearched, progress);
    // what was put back may pass through what another collapse has changed
    std::fill(isChanged.begin(), isChanged.end(), std::uint8_t{0});
    bool isAny = false;
    for (const auto& pair : crossings)
      for (const std::uint32_t f : pair) {
        if (by[f] == kNone || m_collapses[by[f]].isUndone) continue;
        undo(m_collapses[by[f]]);
        for (const auto& [g, t] : before(m_collapses[by[f]])) isChanged[g] = 1;
        isAny = true;
      }
    if (!isAny) return;
  }
}

void CollapsingMesh::endPass() {
  std::size_t to = 0;
  for (std::size_t f = 0; f < m_triangle.size(); ++f) {
    if (m_isDropped[f] != 0) continue;
    m_triangle[to] = m_triangle[f];
    m_surface.group[to] = m_surface.group[f];
    m_firstGone[to] = m_firstGone[f];
    m_isCloseTriangle[to] = m_isCloseTriangle[f];
    ++to;
  }
  m_triangle.resize(to);
  m_surface.group.resize(to);
  m_firstGone.resize(to);
  m_isCloseTriangle.resize(to);
}

void CollapsingMesh::dropVertices() {
  std::vector<std::uint32_t> to(m_place.size(), kNone);
  for (const Triangle& t : m_triangle)
    for (const std::uint32_t v : t) to[v] = 0;
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < to.size(); ++v) {
    if (to[v] == kNone) continue;
    m_place[count] = m_place[v];
    m_surface.node[count] = m_surface.node[v];
    to[v] = count++;
  }
  m_place.resize(count);
  m_surface.node.resize(count);
  for (Triangle& t : m_triangle)
    for (std::uint32_t& v : t) v = to[v];
}

}  // namespace lumen::convert
