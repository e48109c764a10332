// SPDX-License-Identifier: Apache-2.0
// growTree() of lattice_topology.h.
#include <algorithm>
#include <array>
#include <deque>

#include "converters/stages/surface/lattice_topology.h"

namespace lumen::convert {
namespace {

constexpr double kCore = 0.35;       // radii: the part that is grown first, along the axes
constexpr std::size_t kDepths = 64;  // steps from the axis to the wall

using Tetrahedron = SampledLattice::Tetrahedron;

// Topology of the grown part of a vertex' link: the link is a sphere of triangles, one for each
// tetrahedron.
struct LinkFacts {
  int parts = 0;
  int euler = 0;
  // Adding the vertex changes nothing: it touches a disc.
  [[nodiscard]] bool isSimple() const { return parts == 1 && euler == 1; }
  // Adding it closes one loop: it touches two discs.
  [[nodiscard]] bool isBridge() const { return parts == 2 && euler == 2; }
};

class TreeGrowth {
public:
  TreeGrowth(const SampledLattice& lattice, const SeparatedField& field, std::uint32_t lumen,
             const std::vector<std::uint32_t>& lumens)
      : m_lattice(lattice), m_field(field) {
    number(lumen, lumens);
    gather(lumens, lumen);
  }

  std::vector<std::uint32_t> run(std::uint32_t start, std::size_t links) {
    m_queue.resize(kDepths + 2);
    add(m_local[start]);
    flood();
    for (std::size_t i = 0; i < links && closeLoop(); ++i) flood();
    std::vector<std::uint32_t> left;
    for (std::uint32_t v = 0; v < m_vertex.size(); ++v)
      if (!m_isGrown[v]) left.push_back(m_vertex[v]);
    return left;
  }

private:
  static constexpr std::uint32_t kOther = UINT32_MAX;  // a vertex that is not of this lumen

  void number(std::uint32_t lumen, const std::vector<std::uint32_t>& lumens) {
    m_local.assign(lumens.size(), kOther);
    for (std::uint32_t v = 0; v < lumens.size(); ++v) {
      if (lumens[v] != lumen) continue;
      m_local[v] = static_cast<std::uint32_t>(m_vertex.size());
      m_vertex.push_back(v);
    }
    m_isGrown.assign(m_vertex.size(), false);
    m_isQueued.assign(m_vertex.size(), false);
  }

  // The tetrahedra at each vertex, in CSR form.
  void gather(const std::vector<std::uint32_t>& lumens, std::uint32_t lumen) {
    std::vector<std::vector<Tetrahedron>> found(m_lattice.blockCount());
    m_lattice.eachTetrahedron([&](std::size_t block, const Tetrahedron& t) {
      const auto inside =
          std::count_if(t.begin(), t.end(), [&](auto v) { return lumens[v] == lumen; });
      if (inside < 2) return;
      found[block].push_back({m_local[t[0]], m_local[t[1]], m_local[t[2]], m_local[t[3]]});
    });
    m_tetrahedron = SampledLattice::joined(found);
    m_offset.assign(m_vertex.size() + 1, 0);
    for (const Tetrahedron& t : m_tetrahedron)
      for (const std::uint32_t v : t)
        if (v != kOther) ++m_offset[v + 1];
    for (std::size_t i = 0; i < m_vertex.size(); ++i) m_offset[i + 1] += m_offset[i];
    m_at.resize(m_offset.back());
    std::vector<std::uint32_t> next(m_offset.begin(), m_offset.end() - 1);
    for (std::uint32_t i = 0; i < m_tetrahedron.size(); ++i)
      for (const std::uint32_t v : m_tetrahedron[i])
        if (v != kOther) m_at[next[v]++] = i;
  }

  [[nodiscard]] bool areJoined(std::uint32_t a, std::uint32_t b) const {
    return m_lattice.areJoined(m_vertex[a], m_vertex[b]);
  }

  [[nodiscard]] LinkFacts link(std::uint32_t v) const {
    constexpr std::size_t kMostNeighbours = 64;
    std::array<std::uint32_t, kMostNeighbours> vertex{};
    std::array<std::uint8_t, kMostNeighbours> set{};
    std::size_t count = 0;
    const auto place = [&](std::uint32_t w) -> std::size_t {
      for (std::size_t i = 0; i < count; ++i)
        if (vertex[i] == w) return i;
      if (count == kMostNeighbours) return kMostNeighbours;
      set[count] = static_cast<std::uint8_t>(count);
      vertex[count] = w;
      return count++;
    };
    const auto root = [&](std::size_t i) {
      while (set[i] != i) i = set[i];
      return i;
    };
    int halfEdges = 0, faces = 0;
    for (std::uint32_t k = m_offset[v]; k < m_offset[v + 1]; ++k) {
      std::array<std::size_t, 3> at{};
      std::size_t grown = 0;
      for (const std::uint32_t w : m_tetrahedron[m_at[k]])
        if (w != v && w != kOther && m_isGrown[w] && areJoined(v, w)) at[grown++] = place(w);
      if (grown > 0 && at[grown - 1] == kMostNeighbours) return {};
      int edges = 0;
      for (std::size_t i = 0; i < grown; ++i)
        for (std::size_t j = i + 1; j < grown; ++j) {
          if (!areJoined(vertex[at[i]], vertex[at[j]])) continue;
          ++edges;
          const std::size_t a = root(at[i]), b = root(at[j]);
          set[std::max(a, b)] = static_cast<std::uint8_t>(std::min(a, b));
        }
      halfEdges += edges;
      if (edges == 3) ++faces;
    }
    LinkFacts facts{0, static_cast<int>(count) - halfEdges / 2 + faces};
    for (std::size_t i = 0; i < count; ++i) facts.parts += set[i] == i ? 1 : 0;
    return facts;
  }

  [[nodiscard]] std::size_t priority(std::uint32_t v) const {
    const std::uint32_t vertex = m_vertex[v], node = m_lattice.node(vertex);
    if (m_field.axisShare(m_lattice.place(vertex), node) < kCore) return 0;
    const double depth =
        std::clamp(1 + m_lattice.distance(vertex) / m_field.radius(node), 0.0, 1.0);
    return 1 + static_cast<std::size_t>(depth * static_cast<double>(kDepths));
  }

  void add(std::uint32_t v) {
    m_isGrown[v] = true;
    for (std::uint32_t k = m_offset[v]; k < m_offset[v + 1]; ++k)
      for (const std::uint32_t w : m_tetrahedron[m_at[k]]) {
        if (w == kOther || m_isGrown[w] || m_isQueued[w]) continue;
        m_isQueued[w] = true;
        m_queue[priority(w)].push_back(w);
      }
  }

  void flood() {
    for (std::size_t depth = 0; depth < m_queue.size();) {
      if (m_queue[depth].empty()) {
        ++depth;
        continue;
      }
      const std::uint32_t v = m_queue[depth].front();
      m_queue[depth].pop_front();
      m_isQueued[v] = false;
      if (m_isGrown[v] || !link(v).isSimple()) continue;
      add(v);
      depth = 0;
    }
  }

  // Closes a loop where two fronts have met on an axis.
  bool closeLoop() {
    std::uint32_t best = kOther;
    double least = 0;
    for (std::uint32_t v = 0; v < m_vertex.size(); ++v) {
      if (m_isGrown[v]) continue;
      const double share =
          m_field.axisShare(m_lattice.place(m_vertex[v]), m_lattice.node(m_vertex[v]));
      if ((best != kOther && share >= least) || !link(v).isBridge()) continue;
      best = v;
      least = share;
    }
    if (best == kOther) return false;
    add(best);
    return true;
  }

  const SampledLattice& m_lattice;
  const SeparatedField& m_field;
  std::vector<std::uint32_t> m_vertex, m_local;  // this lumen's: local to lattice, and back
  std::vector<Tetrahedron> m_tetrahedron;        // made of local vertices
  std::vector<std::uint32_t> m_offset, m_at;
  std::vector<bool> m_isGrown, m_isQueued;
  std::vector<std::deque<std::uint32_t>> m_queue;
};

}  // namespace

std::vector<Eigen::Vector3d> growTree(SampledLattice& lattice, const SeparatedField& field,
                                      const TreeLumen& tree,
                                      const std::vector<std::uint32_t>& lumens) {
  const std::vector<std::uint32_t> left =
      TreeGrowth(lattice, field, tree.lumen, lumens).run(tree.start, tree.links);
  // one place for vertices that lie together
  std::vector<Eigen::Vector3d> places;
  for (const std::uint32_t v : left) {
    const Eigen::Vector3d at = lattice.place(v);
    const double near = field.radius(lattice.node(v));
    lattice.setInside(v, false);
    const bool isKnown = std::any_of(places.begin(), places.end(), [&](const Eigen::Vector3d& p) {
      return (p - at).norm() < near;
    });
    if (!isKnown) places.push_back(at);
  }
  return places;
}

}  // namespace lumen::convert
