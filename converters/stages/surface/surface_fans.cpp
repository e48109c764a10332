// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/surface_fans.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace lumen::convert {

SurfaceFans::SurfaceFans(CaseSurface& surface)
    : m_surface(surface),
      m_offset(surface.mesh.position.size() + 1, 0),
      m_triangle(3 * surface.mesh.triangle.size()),
      m_isRemoved(surface.mesh.triangle.size(), false) {
  const std::vector<Triangle>& triangle = surface.mesh.triangle;
  for (const Triangle& t : triangle)
    for (const std::uint32_t v : t) ++m_offset[v + 1];
  for (std::size_t v = 0; v + 1 < m_offset.size(); ++v) m_offset[v + 1] += m_offset[v];
  std::vector<std::uint32_t> next(m_offset.begin(), m_offset.end() - 1);
  for (std::uint32_t t = 0; t < triangle.size(); ++t)
    for (const std::uint32_t v : triangle[t]) m_triangle[next[v]++] = t;
}

std::span<const std::uint32_t> SurfaceFans::of(std::uint32_t vertex) const {
  const auto found = m_changed.find(vertex);
  if (found != m_changed.end()) return found->second;
  return std::span(m_triangle).subspan(m_offset[vertex], m_offset[vertex + 1] - m_offset[vertex]);
}

bool SurfaceFans::areJoined(std::uint32_t a, std::uint32_t b) const {
  const auto fan = of(a);
  return std::any_of(fan.begin(), fan.end(), [&](std::uint32_t t) {
    const Triangle& corner = m_surface.mesh.triangle[t];
    return std::find(corner.begin(), corner.end(), b) != corner.end();
  });
}

std::vector<std::uint32_t>& SurfaceFans::changed(std::uint32_t vertex) {
  const auto fan = m_changed.count(vertex) > 0 ? std::span<const std::uint32_t>() : of(vertex);
  return m_changed.try_emplace(vertex, fan.begin(), fan.end()).first->second;
}

std::uint32_t SurfaceFans::addVertex(const Eigen::Vector3d& position, std::uint32_t node) {
  const auto vertex = static_cast<std::uint32_t>(m_surface.mesh.position.size());
  m_surface.mesh.position.push_back(position);
  m_surface.node.push_back(node);
  m_changed[vertex];
  return vertex;
}

void SurfaceFans::add(const Triangle& triangle, std::uint32_t group) {
  for (const std::uint32_t v : triangle)
    changed(v).push_back(static_cast<std::uint32_t>(m_surface.mesh.triangle.size()));
  m_surface.mesh.triangle.push_back(triangle);
  m_surface.group.push_back(group);
  m_isRemoved.push_back(false);
}

void SurfaceFans::remove(std::uint32_t triangle) {
  for (const std::uint32_t v : m_surface.mesh.triangle[triangle]) std::erase(changed(v), triangle);
  m_isRemoved[triangle] = true;
}

void SurfaceFans::compact() {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  TriangleMesh& mesh = m_surface.mesh;
  std::size_t kept = 0;
  std::vector<std::uint32_t> number(mesh.position.size(), kUnused);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (m_isRemoved[t]) continue;
    for (const std::uint32_t v : mesh.triangle[t]) number[v] = 0;
    mesh.triangle[kept] = mesh.triangle[t];
    m_surface.group[kept++] = m_surface.group[t];
  }
  mesh.triangle.resize(kept);
  m_surface.group.resize(kept);
  std::uint32_t vertices = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    mesh.position[vertices] = Eigen::Vector3d(mesh.position[v]);
    m_surface.node[vertices] = m_surface.node[v];
    number[v] = vertices++;
  }
  mesh.position.resize(vertices);
  m_surface.node.resize(vertices);
  for (Triangle& t : mesh.triangle)
    for (std::uint32_t& v : t) v = number[v];
}

}  // namespace lumen::convert
