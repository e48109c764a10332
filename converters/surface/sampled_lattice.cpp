// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/sampled_lattice.h"

#include <algorithm>

namespace lumen::convert {

SampledLattice::SampledLattice(const SheetField& field, double share, Progress& progress)
    : m_field(field), m_lattice(field, share, progress), m_vertices(m_lattice) {
  progress.check();
  m_distance.resize(size());
  m_node.resize(size());
  m_isInside.resize(size());
  tbb::parallel_for(std::size_t{0}, size(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    const SheetSample sample = m_field.deepest(place(v), m_vertices.cubeOf(v).node);
    m_node[i] = sample.node;
    m_distance[i] = sample.distance;
    m_isInside[i] = sample.distance < 0 && !isOutermost(v);
  });
  progress.check();
  findSplitEdges();
}

bool SampledLattice::isOneLumen(std::uint32_t u, std::uint32_t v) const {
  const std::uint32_t a = m_node[u], b = m_node[v];
  if (a == b || !m_field.mayTouch(a) || !m_field.mayTouch(b)) return true;
  return m_field.isReached(place(v), a, b) || m_field.isReached(place(u), b, a);
}

void SampledLattice::force(std::uint32_t vertex, const SheetSample& sample) {
  constexpr double kDepth = 1e-3;  // of the radius
  m_isInside[vertex] = 1;
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
  const LatticeCube* cube = m_lattice.cubeAt(point);
  return cube == nullptr ? std::vector<std::uint32_t>() : m_vertices.verticesOf(*cube);
}

}  // namespace lumen::convert
