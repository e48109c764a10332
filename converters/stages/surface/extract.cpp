// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/extract.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/surface/lattice_topology.h"
#include "converters/stages/surface/marching_tetrahedra.h"
#include "converters/stages/surface/sampled_lattice.h"
#include "converters/stages/surface/surface_fans.h"

namespace lumen::convert {

std::size_t dropHollows(CaseSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  DisjointSets sets(mesh.position.size());
  for (const Triangle& t : mesh.triangle) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<double> volume(mesh.position.size(), 0);
  for (const Triangle& t : mesh.triangle) {
    const std::uint32_t part = sets.find(t[0]);
    const Eigen::Vector3d& origin = mesh.position[part];
    volume[part] += tetrahedronVolume(mesh.position[t[0]] - origin, mesh.position[t[1]] - origin,
                                      mesh.position[t[2]] - origin);
  }
  std::size_t dropped = 0;
  for (const double of : volume) dropped += of < 0 ? 1 : 0;
  if (dropped == 0) return 0;
  SurfaceFans fans(surface);
  const auto count = static_cast<std::uint32_t>(mesh.triangle.size());
  for (std::uint32_t t = 0; t < count; ++t)
    if (volume[sets.find(mesh.triangle[t][0])] < 0) fans.remove(t);
  fans.compact();
  return dropped;
}

namespace {

constexpr double kNearEnd = 0.03;     // share of an edge: crossings keep off its ends
constexpr std::size_t kBlock = 1024;  // vertices between two reports of progress

class SurfaceExtraction {
public:
  SurfaceExtraction(const SeparatedField& field, const LatticeEdge& edge, ExtractionReport& report,
                    Progress& progress)
      : m_field(field), m_report(report), m_progress(progress), m_lattice(field, edge, progress) {}

  CaseSurface run() {
    m_progress.begin("topology", 0);
    m_lumens = labelLumens(m_lattice);
    m_trees = joinTrees(m_lattice, m_field, m_lumens, m_report.openedEdges);
    m_report.trees = m_trees.size();
    m_progress.check();
    march();
    if (m_field.options().isUnion) {
      m_progress.end();
      CaseSurface surface = assemble();
      dropHollows(surface);
      return surface;
    }
    bool isGrown = false;
    for (const TreeLumen& tree : m_trees) {
      if (tree.lumen == kOutside ||
          eulerCharacteristic(tree.lumen) == 2 - 2 * std::ptrdiff_t(tree.links))
        continue;
      m_progress.check();
      const auto cuts = growTree(m_lattice, m_field, tree, m_lumens);
      m_report.cuts.insert(m_report.cuts.end(), cuts.begin(), cuts.end());
      isGrown = true;
    }
    if (isGrown) march();
    m_progress.check();
    m_progress.end();
    return assemble();
  }

private:
  void march() {
    std::vector<std::vector<CrossingTriangle>> found(m_lattice.blockCount());
    const auto inside = [&](std::uint32_t v) { return m_lattice.isInside(v); };
    m_lattice.eachTetrahedron([&](std::size_t block, const SampledLattice::Tetrahedron& t) {
      marchTetrahedron(t, m_lattice.split(), inside, found[block]);
    });
    m_triangles = SampledLattice::joined(found);
    found = {};
    gatherCrossings();
  }

  /// The crossings of all triangles, each once, in order: those of a vertex together.
  void gatherCrossings() {
    const std::size_t vertices = m_lattice.size();
    std::vector<std::size_t> first(vertices + 1, 0), next;
    for (const CrossingTriangle& t : m_triangles)
      for (const Crossing& c : t) ++first[c.inside + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    next.assign(first.begin(), first.end() - 1);
    std::vector<std::uint32_t> outside(first.back());
    for (const CrossingTriangle& t : m_triangles)
      for (const Crossing& c : t) outside[next[c.inside]++] = c.outside;
    tbb::parallel_for(std::size_t{0}, vertices, [&](std::size_t v) {
      const auto begin = outside.begin() + static_cast<std::ptrdiff_t>(first[v]);
      const auto end = outside.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
      std::sort(begin, end);
      next[v] = static_cast<std::size_t>(std::unique(begin, end) - begin);
    });
    m_firstCrossing.assign(vertices + 1, 0);
    std::partial_sum(next.begin(), next.end(), m_firstCrossing.begin() + 1);
    m_crossings.resize(m_firstCrossing.back());
    tbb::parallel_for(std::size_t{0}, vertices, [&](std::size_t v) {
      for (std::size_t i = 0; i < next[v]; ++i)
        m_crossings[m_firstCrossing[v] + i] = {static_cast<std::uint32_t>(v),
                                               outside[first[v] + i]};
    });
  }

  // Euler characteristic of the closed surfaces around a lumen: each edge is that of two triangles.
  [[nodiscard]] std::ptrdiff_t eulerCharacteristic(std::uint32_t lumen) const {
    const auto isInLumen = [&](const Crossing& c) { return m_lumens[c.inside] == lumen; };
    const auto vertices = std::count_if(m_crossings.begin(), m_crossings.end(), isInLumen);
    const auto triangles =
        std::count_if(m_triangles.begin(), m_triangles.end(),
                      [&](const CrossingTriangle& t) { return isInLumen(t[0]); });
    return vertices - triangles / 2;
  }

  CaseSurface assemble() {
    placeSplits();
    CaseSurface surface;
    surface.groups = {{"wall", FaceKind::Wall}};
    surface.mesh.triangle.resize(m_triangles.size());
    surface.group.assign(m_triangles.size(), 0);
    tbb::parallel_for(std::size_t{0}, m_triangles.size(), [&](std::size_t i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Crossing& corner = m_triangles[i][k];
        const auto at =
            std::lower_bound(&m_crossings[m_firstCrossing[corner.inside]],
                             m_crossings.data() + m_firstCrossing[corner.inside + 1], corner);
        surface.mesh.triangle[i][k] = static_cast<std::uint32_t>(at - m_crossings.data());
      }
    });
    surface.mesh.position.resize(m_crossings.size());
    surface.node.resize(m_crossings.size());
    m_progress.begin("extracting", m_crossings.size());
    tbb::parallel_for(std::size_t{0}, m_crossings.size(), [&](std::size_t i) {
      if (i % kBlock == 0) {
        m_progress.check();
        m_progress.advance(std::min(kBlock, m_crossings.size() - i));
      }
      place(m_crossings[i], surface.mesh.position[i], surface.node[i]);
    });
    m_progress.end();
    return surface;
  }

  // Where both walls and the point between them are on a split edge, as shares of it from its first
  // end: each wall is on its own side of the point, so no two triangles pass through each other.
  struct SplitPlace {
    double first = 0, point = 0.5, second = 1;
  };

  void placeSplits() {
    const SplitEdges& split = m_lattice.split();
    m_splits.resize(split.size());
    tbb::parallel_for(std::size_t{0}, m_splits.size(), [&](std::size_t i) {
      const auto& [u, v] = split.edgeOf(split.firstPoint() + static_cast<std::uint32_t>(i));
      const double own = shareTo(u, m_lattice.place(v)), other = shareTo(v, m_lattice.place(u));
      SplitPlace& at = m_splits[i];
      if (own + other < 1) {
        at = {own, own < 0.5 && other < 0.5 ? 0.5 : 0.5 * (own + 1 - other), 1 - other};
        return;
      }
      at.point = own / (own + other);
      at.first = at.point * (1 - 2 * kNearEnd);
      at.second = 1 - (1 - at.point) * (1 - 2 * kNearEnd);
    });
  }

  [[nodiscard]] Eigen::Vector3d between(std::uint32_t u, std::uint32_t v, double share) const {
    const Eigen::Vector3d from = m_lattice.place(u);
    return from + share * (m_lattice.place(v) - from);
  }

  // The place where the wall of the sheet at a vertex crosses an edge that leads from there, as a
  // share of the edge, by the false position.
  [[nodiscard]] double shareTo(std::uint32_t inside, const Eigen::Vector3d& out) const {
    constexpr int kSteps = 2;
    const Eigen::Vector3d in = m_lattice.place(inside);
    const std::uint32_t node = m_lattice.node(inside);
    double low = 0, high = 1, atLow = m_lattice.distance(inside);
    double atHigh = m_field.at(out, node).distance, t = 0.5;
    if (!(atHigh > 0)) return t;
    const auto straight = [&] { return low + (high - low) * atLow / (atLow - atHigh); };
    for (int step = 0; step < kSteps; ++step) {
      t = straight();
      const double distance = m_field.at(in + t * (out - in), node).distance;
      (distance < 0 ? low : high) = t;
      (distance < 0 ? atLow : atHigh) = distance;
    }
    return std::clamp(straight(), kNearEnd, 1 - kNearEnd);
  }

  void place(const Crossing& crossing, Eigen::Vector3d& position, std::uint32_t& node) const {
    const std::uint32_t inside = crossing.inside;
    if (crossing.outside < m_lattice.size()) {
      const Eigen::Vector3d out = m_lattice.place(crossing.outside);
      position = m_lattice.place(inside) + shareTo(inside, out) * (out - m_lattice.place(inside));
    } else {
      const auto& [u, v] = m_lattice.split().edgeOf(crossing.outside);
      const SplitPlace& at = m_splits[crossing.outside - m_lattice.split().firstPoint()];
      if (inside == u) {
        position = between(u, v, at.first);
      } else if (inside == v) {
        position = between(v, u, 1 - at.second);
      } else {
        const Eigen::Vector3d out = between(u, v, at.point);
        position = m_lattice.place(inside) + shareTo(inside, out) * (out - m_lattice.place(inside));
      }
    }
    node = m_field.at(position, m_lattice.node(inside)).node;
  }

  const SeparatedField& m_field;
  ExtractionReport& m_report;
  Progress& m_progress;
  SampledLattice m_lattice;
  std::vector<std::uint32_t> m_lumens;
  std::vector<TreeLumen> m_trees;
  std::vector<CrossingTriangle> m_triangles;
  std::vector<Crossing> m_crossings;         // ascending
  std::vector<std::size_t> m_firstCrossing;  // by vertex
  std::vector<SplitPlace> m_splits;          // by the points of split edges
};

}  // namespace

CaseSurface extractSurface(const SeparatedField& field, const LatticeEdge& edge,
                           ExtractionReport& report, Progress& progress) {
  return SurfaceExtraction(field, edge, report, progress).run();
}

}  // namespace lumen::convert
