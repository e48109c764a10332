// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/extract.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "converters/common/disjoint_sets.h"
#include "converters/surface/adaptive_lattice.h"
#include "converters/surface/lattice_vertices.h"
#include "converters/surface/marching_tetrahedra.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kBlock = 1024;  // cubes that one thread takes at a time
constexpr double kNearEnd = 0.03;     // of an edge: crossings keep off its ends

using Edge = std::pair<std::uint32_t, std::uint32_t>;

class Extraction {
public:
  Extraction(const SheetField& field, double share, Progress& progress)
      : m_field(field), m_lattice(field, share, progress), m_vertices(m_lattice), m_progress(progress) {}

  CaseSurface run() {
    sampleField();
    m_progress.check();
    const SplitEdges split(splitEdges(), static_cast<std::uint32_t>(m_vertices.size()));
    m_progress.check();
    return assemble(march(split), split);
  }

private:
  void sampleField() {
    m_distance.resize(m_vertices.size());
    m_node.resize(m_vertices.size());
    tbb::parallel_for(std::size_t{0}, m_vertices.size(), [&](std::size_t i) {
      const auto v = static_cast<std::uint32_t>(i);
      const SheetSample sample = m_field.deepest(m_vertices.place(v), m_vertices.cubeOf(v).node);
      m_node[i] = sample.node;
      m_distance[i] = m_vertices.isOutermost(v) ? std::abs(sample.distance) : sample.distance;
    });
  }

  [[nodiscard]] bool isInside(std::uint32_t vertex) const { return m_distance[vertex] < 0; }

  // Whether a cursor gets from the one end to the other: both are inside.
  [[nodiscard]] bool areJoined(std::uint32_t u, std::uint32_t v) const {
    const std::uint32_t a = m_node[u], b = m_node[v];
    if (a == b || !m_field.mayTouch(a) || !m_field.mayTouch(b)) return true;
    return m_field.isReached(m_vertices.place(v), a, b) || m_field.isReached(m_vertices.place(u), b, a);
  }

  // Calls work(block, first, last) for blocks of cubes.
  template <class Work>
  std::size_t eachBlock(const Work& work) const {
    const std::size_t count = m_lattice.cubes().size(), blocks = (count + kBlock - 1) / kBlock;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
      work(block, block * kBlock, std::min(count, (block + 1) * kBlock));
    });
    return blocks;
  }
  [[nodiscard]] std::size_t blockCount() const {
    return (m_lattice.cubes().size() + kBlock - 1) / kBlock;
  }

  std::vector<Edge> splitEdges() const {
    std::vector<std::vector<Edge>> found(blockCount());
    eachBlock([&](std::size_t block, std::size_t first, std::size_t last) {
      for (std::size_t cube = first; cube < last; ++cube) {
        if (!m_field.mayTouch(m_lattice.cubes()[cube].node)) continue;
        m_vertices.eachTetrahedron(static_cast<std::uint32_t>(cube), [&](const auto& t) {
          for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
              if (isInside(t[i]) && isInside(t[j]) && !areJoined(t[i], t[j]))
                found[block].push_back(std::minmax(t[i], t[j]));
        });
      }
    });
    return joined(found);
  }

  std::vector<CrossingTriangle> march(const SplitEdges& split) const {
    std::vector<std::vector<CrossingTriangle>> found(blockCount());
    eachBlock([&](std::size_t block, std::size_t first, std::size_t last) {
      const auto inside = [&](std::uint32_t v) { return isInside(v); };
      for (std::size_t cube = first; cube < last; ++cube)
        m_vertices.eachTetrahedron(static_cast<std::uint32_t>(cube), [&](const auto& t) {
          marchTetrahedron(t, split, inside, found[block]);
        });
    });
    return joined(found);
  }

  template <class T>
  static std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> all;
    for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  // Numbers the crossings and places them.
  CaseSurface assemble(const std::vector<CrossingTriangle>& triangles, const SplitEdges& split) const {
    std::vector<Crossing> crossings;
    crossings.reserve(triangles.size() * 3);
    for (const CrossingTriangle& t : triangles) crossings.insert(crossings.end(), t.begin(), t.end());
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    CaseSurface surface;
    surface.groups = {{"wall", FaceKind::Wall}};
    surface.mesh.triangle.resize(triangles.size());
    surface.group.assign(triangles.size(), 0);
    tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = std::lower_bound(crossings.begin(), crossings.end(), triangles[i][k]);
        surface.mesh.triangle[i][k] = static_cast<std::uint32_t>(at - crossings.begin());
      }
    });
    surface.mesh.position.resize(crossings.size());
    surface.node.resize(crossings.size());
    tbb::parallel_for(std::size_t{0}, crossings.size(), [&](std::size_t i) {
      place(crossings[i], split, surface.mesh.position[i], surface.node[i]);
    });
    return surface;
  }

  // Where the wall of the sheet at the inside end crosses the edge: two steps of the false position.
  void place(const Crossing& crossing, const SplitEdges& split, Eigen::Vector3d& position,
             std::uint32_t& node) const {
    const Eigen::Vector3d in = m_vertices.place(crossing.inside);
    Eigen::Vector3d out;
    if (crossing.outside < split.firstPoint()) {
      out = m_vertices.place(crossing.outside);
    } else {
      const auto& [u, v] = split.edgeOf(crossing.outside);
      out = 0.5 * (m_vertices.place(u) + m_vertices.place(v));
      if (u == crossing.inside) out = m_vertices.place(v);
      if (v == crossing.inside) out = m_vertices.place(u);
    }
    node = m_node[crossing.inside];
    double low = 0, high = 1, atLow = m_distance[crossing.inside];
    SheetSample sample = m_field.at(out, node);
    double atHigh = sample.distance, t = 0.5;
    for (int step = 0; step < 2 && atHigh > 0; ++step) {
      t = low + (high - low) * atLow / (atLow - atHigh);
      sample = m_field.at(in + t * (out - in), node);
      (sample.distance < 0 ? low : high) = t;
      (sample.distance < 0 ? atLow : atHigh) = sample.distance;
    }
    if (atHigh > 0) t = low + (high - low) * atLow / (atLow - atHigh);
    t = std::clamp(t, kNearEnd, 1 - kNearEnd);
    position = in + t * (out - in);
    node = m_field.at(position, node).node;
  }

  const SheetField& m_field;
  AdaptiveLattice m_lattice;
  LatticeVertices m_vertices;
  Progress& m_progress;
  std::vector<double> m_distance;     // of the deepest sheet, mm
  std::vector<std::uint32_t> m_node;  // that sheet's
};

}  // namespace

CaseSurface extractSurface(const SheetField& field, double share, ExtractionReport& report,
                           Progress& progress) {
  CaseSurface surface = Extraction(field, share, progress).run();
  (void)report;
  return surface;
}

}  // namespace lumen::convert
