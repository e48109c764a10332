// SPDX-License-Identifier: Apache-2.0
// The inside of a lattice, and its division into lumens.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/progress.h"
#include "converters/stages/surface/adaptive_lattice.h"
#include "converters/stages/surface/lattice_vertices.h"
#include "converters/stages/surface/marching_tetrahedra.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

/// The field at the vertices of a lattice. A vertex belongs to one sheet, the one whose axis is
/// nearest; two neighbours that are inside are joined if a cursor gets from one to the other.
class SampledLattice {
public:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  using Tetrahedron = LatticeVertices::Tetrahedron;

  SampledLattice(const SeparatedField& field, const LatticeEdge& edge, Progress& progress);

  [[nodiscard]] std::size_t size() const { return m_vertices.size(); }
  [[nodiscard]] Eigen::Vector3d place(std::uint32_t vertex) const {
    return m_vertices.place(vertex);
  }
  /// Distance to the vertex' sheet, mm; negative inside.
  [[nodiscard]] double distance(std::uint32_t vertex) const { return m_distance[vertex]; }
  [[nodiscard]] std::uint32_t node(std::uint32_t vertex) const { return m_node[vertex]; }
  [[nodiscard]] bool isInside(std::uint32_t vertex) const { return m_isInside[vertex] != 0; }
  [[nodiscard]] bool isOutermost(std::uint32_t vertex) const {
    return m_vertices.isOutermost(vertex);
  }

  /// Puts a vertex inside or outside, whatever the field is there.
  void setInside(std::uint32_t vertex, bool isInside) { m_isInside[vertex] = isInside ? 1 : 0; }
  /// Makes a vertex inside, of a sheet; update() is due then.
  void force(std::uint32_t vertex, const SeparatedSample& sample);
  void update();
  /// The edges with both ends inside that are not joined.
  [[nodiscard]] const SplitEdges& split() const { return m_split; }

  /// Whether the edge between two vertices that are inside is not split.
  [[nodiscard]] bool areJoined(std::uint32_t u, std::uint32_t v) const {
    return !(m_isOnSplit[u] && m_isOnSplit[v]) || m_split.pointOn(u, v) == SplitEdges::kNone;
  }

  /// The vertices of the cube that holds a point: its centre, and its corners. Empty outside.
  [[nodiscard]] std::vector<std::uint32_t> verticesAround(const Eigen::Vector3d& point) const;

  /// Calls work(block, tetrahedron) for all tetrahedra that had a vertex inside when the lattice
  /// was sampled or forced, with blocks in parallel; the tetrahedra of a block come in one order.
  /// There are blockCount() blocks.
  template <class Work>
  void eachTetrahedron(const Work& work) const {
    tbb::parallel_for(std::size_t{0}, m_tetrahedra.size(), [&](std::size_t block) {
      for (const Tetrahedron& t : m_tetrahedra[block]) work(block, t);
    });
  }
  /// Calls visit(tetrahedron) for the tetrahedra of eachTetrahedron(), one after another.
  template <class Visit>
  void eachTetrahedronInTurn(const Visit& visit) const {
    for (const std::vector<Tetrahedron>& block : m_tetrahedra)
      for (const Tetrahedron& t : block) visit(t);
  }
  [[nodiscard]] std::size_t blockCount() const { return m_tetrahedra.size(); }

  template <class T>
  static std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::size_t count = 0;
    for (const std::vector<T>& part : parts) count += part.size();
    std::vector<T> all;
    all.reserve(count);
    for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

private:
  static constexpr std::size_t kBlock = 1024;  // cubes that one thread takes at a time
  void gatherTetrahedra(const std::vector<std::uint8_t>& changed);
  void findSplitEdges();
  [[nodiscard]] bool isOneLumen(std::uint32_t u, std::uint32_t v) const;

  const SeparatedField& m_field;
  AdaptiveLattice m_lattice;
  LatticeVertices m_vertices;
  std::vector<double> m_distance;
  std::vector<std::uint32_t> m_node;
  std::vector<std::uint8_t> m_isInside;
  std::vector<std::uint8_t> m_isForced;                // since the tetrahedra were gathered
  std::vector<std::vector<Tetrahedron>> m_tetrahedra;  // by blocks of cubes
  SplitEdges m_split{{}, 0};
  std::vector<bool> m_isOnSplit;
};

}  // namespace lumen::convert
