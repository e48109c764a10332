// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/sampled_lattice.h"

#include <algorithm>
#include <cstddef>

namespace lumen::convert {

SampledLattice::SampledLattice(const SeparatedField& field, const LatticeEdge& edge,
                               Progress& progress)
    : m_field(field), m_lattice(field, edge, progress), m_vertices(m_lattice) {
  progress.check();
  m_distance.resize(size());
  m_node.resize(size());
  m_isInside.resize(size());
  progress.begin("lattice", size());
  tbb::parallel_for(std::size_t{0}, size(), [&](std::size_t i) {
    if (i % kBlock == 0) {
      progress.check();
      progress.advance(std::min(kBlock, size() - i));
    }
    const auto v = static_cast<std::uint32_t>(i);
    const SeparatedSample sample = m_field.deepest(place(v), m_vertices.cubeOf(v).node);
    m_node[i] = sample.node;
    m_distance[i] = sample.distance;
    m_isInside[i] = sample.distance < 0 && !isOutermost(v);
  });
  progress.end();
  progress.check();
  m_isForced = m_isInside;
  update();
}

void SampledLattice::update() {
  gatherTetrahedra(m_isForced);
  m_isForced.assign(size(), 0);
  findSplitEdges();
}

// The tetrahedra of blocks near vertices that have changed.
void SampledLattice::gatherTetrahedra(const std::vector<std::uint8_t>& changed) {
  const std::size_t count = m_lattice.cubes().size();
  const std::vector<std::uint8_t> isNear = m_vertices.cubesNear(m_isInside),
                                  isChanged = m_vertices.cubesNear(changed);
  m_tetrahedra.resize((count + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, m_tetrahedra.size(), [&](std::size_t block) {
    const std::size_t first = block * kBlock, last = std::min(count, first + kBlock);
    if (std::all_of(isChanged.begin() + static_cast<std::ptrdiff_t>(first),
                    isChanged.begin() + static_cast<std::ptrdiff_t>(last),
                    [](std::uint8_t one) { return one == 0; }))
      return;
    m_tetrahedra[block].clear();
    for (std::size_t cube = first; cube < last; ++cube) {
      if (isNear[cube] == 0) continue;
      m_vertices.eachTetrahedron(static_cast<std::uint32_t>(cube), [&](const Tetrahedron& t) {
        if (isInside(t[0]) || isInside(t[1]) || isInside(t[2]) || isInside(t[3]))
          m_tetrahedra[block].push_back(t);
      });
    }
  });
}

bool SampledLattice::isOneLumen(std::uint32_t u, std::uint32_t v) const {
  const std::uint32_t a = m_node[u], b = m_node[v];
  if (a == b || !m_field.mayTouch(a) || !m_field.mayTouch(b)) return true;
  return m_field.isReached(place(v), a, b) || m_field.isReached(place(u), b, a);
}

void SampledLattice::force(std::uint32_t vertex, const SeparatedSample& sample) {
  constexpr double kDepth = 1e-3;  // radii
  m_isInside[vertex] = m_isForced[vertex] = 1;
  m_node[vertex] = sample.node;
  m_distance[vertex] = std::min(sample.distance, -kDepth * m_field.radius(sample.node));
}

void SampledLattice::findSplitEdges() {
  std::vector<std::vector<Edge>> found(blockCount());
  eachTetrahedron([&](std::size_t block, const Tetrahedron& t) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (isInside(t[i]) && isInside(t[j]) && !isOneLumen(t[i], t[j]))
          found[block].push_back(std::minmax(t[i], t[j]));
  });
  std::vector<Edge> edges = joined(found);
  m_isOnSplit.assign(size(), false);
  for (const auto& [u, v] : edges) m_isOnSplit[u] = m_isOnSplit[v] = true;
  m_split = SplitEdges(std::move(edges), static_cast<std::uint32_t>(size()));
}

std::vector<std::uint32_t> SampledLattice::verticesAround(const Eigen::Vector3d& point) const {
  const std::uint32_t cube = m_lattice.cubeAt(point);
  if (cube == AdaptiveLattice::kNone) return {};
  return m_vertices.verticesOf(cube);
}

}  // namespace lumen::convert
