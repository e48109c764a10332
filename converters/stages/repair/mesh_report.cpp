// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/repair/mesh_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

/// The diagnosis while it is made: triangles with equal points made one, and without those that
/// name a point twice.
class Diagnosis {
public:
  explicit Diagnosis(const TriangleMesh& mesh) : m_mesh(mesh) {}

  MeshReport make(const Progress& progress) {
    countPoints();
    progress.check();
    countTriangles();
    progress.check();
    countEdges();
    countPointFans();
    progress.check();
    traceLoops();
    progress.check();
    splitComponents();
    conclude();
    progress.check();
    const SelfIntersections cuts = selfIntersections(m_clean);
    m_report.selfIntersections = cuts.pairs.size();
    m_report.allSelfIntersections = cuts.isComplete;
    return std::move(m_report);
  }

private:
  void countPoints() {
    m_same = equalPoints(m_mesh.position);
    for (std::size_t i = 0; i < m_same.size(); ++i)
      m_report.duplicatePoints += m_same[i] != i ? 1 : 0;
    m_report.vertices = m_mesh.position.size();
    m_report.triangles = m_mesh.triangle.size();
    const Box3d box = boundingBox(m_mesh);
    m_report.low = box.low;
    m_report.high = box.high;
  }

  void countTriangles() {
    m_clean.position = m_mesh.position;
    std::vector<Triangle> keys;
    m_used.assign(m_mesh.position.size(), false);
    for (const Triangle& t : m_mesh.triangle) {
      const Triangle joined = {m_same[t[0]], m_same[t[1]], m_same[t[2]]};
      for (const std::uint32_t v : joined) m_used[v] = true;
      if (isDegenerate(m_mesh, joined)) ++m_report.degenerateTriangles;
      if (joined[0] == joined[1] || joined[1] == joined[2] || joined[2] == joined[0]) continue;
      m_clean.triangle.push_back(joined);
      keys.push_back(joined);
      std::sort(keys.back().begin(), keys.back().end());
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i)
      m_report.duplicateTriangles += keys[i] == keys[i - 1] ? 1 : 0;
    for (std::size_t v = 0; v < m_used.size(); ++v)
      m_report.unusedPoints += !m_used[m_same[v]] ? 1 : 0;
  }

  void countEdges() {
    const std::size_t points = m_mesh.position.size();
    m_crowded.assign(points, false);
    m_twisted.assign(points, false);
    m_corners = DisjointSets(3 * m_clean.triangle.size());
    m_components = DisjointSets(points);
    forEachEdge(edgeUses(m_clean.triangle), [&](std::span<const EdgeUse> edge) {
      m_components.join(edge[0].low, edge[0].high);
      if (edge.size() == 1) m_boundary.push_back(edge[0].side);
      if (edge.size() == 2) joinCorners(edge[0], edge[1]);
      if (edge.size() <= 2) return;
      ++m_report.nonManifoldEdges;
      m_crowded[edge[0].low] = m_crowded[edge[0].high] = true;
    });
    m_report.boundaryEdges = m_boundary.size();
  }

  void joinCorners(const EdgeUse& a, const EdgeUse& b) {
    const bool isSameDirection =
        startOf(m_clean.triangle, a.side) == startOf(m_clean.triangle, b.side);
    if (isSameDirection) {
      ++m_report.misorientedEdges;
      m_twisted[a.low] = true;
    }
    m_corners.join(a.side, isSameDirection ? b.side : nextSide(b.side));
    m_corners.join(nextSide(a.side), isSameDirection ? nextSide(b.side) : b.side);
  }

  /// Points whose triangles are several fans.
  void countPointFans() {
    std::vector<std::uint32_t> fan(m_mesh.position.size(), kNoSide);
    m_pinched.assign(m_mesh.position.size(), false);
    for (std::uint32_t c = 0; c < 3 * m_clean.triangle.size(); ++c) {
      const std::uint32_t v = startOf(m_clean.triangle, c), set = m_corners.find(c);
      if (fan[v] == kNoSide) fan[v] = set;
      if (fan[v] != set && !m_crowded[v]) m_pinched[v] = true;
    }
    m_report.nonManifoldVertices =
        static_cast<std::size_t>(std::count(m_pinched.begin(), m_pinched.end(), true));
  }

  /// Boundary sides joined to loops: at each point the loop continues in the same fan.
  void traceLoops() {
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> at;  // point, fan, index
    for (std::uint32_t i = 0; i < m_boundary.size(); ++i)
      for (const std::uint32_t corner : {m_boundary[i], nextSide(m_boundary[i])})
        at.emplace_back(startOf(m_clean.triangle, corner), m_corners.find(corner), i);
    std::sort(at.begin(), at.end());
    std::vector<bool> done(m_boundary.size(), false);
    for (std::uint32_t first = 0; first < m_boundary.size(); ++first) {
      if (done[first]) continue;
      BoundaryLoop& loop = m_report.boundaryLoops.emplace_back();
      std::vector<std::uint32_t>& sides = m_loopSides.emplace_back();
      std::uint32_t point = startOf(m_clean.triangle, m_boundary[first]);
      for (std::uint32_t i = first; i != kNoSide;) {
        done[i] = true;
        sides.push_back(m_boundary[i]);
        loop.vertex.push_back(point);
        const bool runsFrom = startOf(m_clean.triangle, m_boundary[i]) == point;
        const std::uint32_t corner = runsFrom ? nextSide(m_boundary[i]) : m_boundary[i];
        point = startOf(m_clean.triangle, corner);
        i = onward(at, point, m_corners.find(corner), done);
      }
      measureLoop(m_clean, loop);
    }
  }

  /// A boundary side at `point` that is not done, of that fan if it can be.
  static std::uint32_t onward(
      const std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>>& at,
      std::uint32_t point, std::uint32_t fan, const std::vector<bool>& done) {
    const auto first = std::lower_bound(at.begin(), at.end(), std::tuple(point, 0U, 0U));
    std::uint32_t any = kNoSide;
    for (auto entry = first; entry != at.end() && std::get<0>(*entry) == point; ++entry) {
      if (done[std::get<2>(*entry)]) continue;
      if (std::get<1>(*entry) == fan) return std::get<2>(*entry);
      if (any == kNoSide) any = std::get<2>(*entry);
    }
    return any;
  }

  void splitComponents() {
    std::vector<std::uint32_t> index(m_mesh.position.size(), kNoSide);
    std::vector<MeshComponent>& list = m_report.components;
    const auto of = [&](std::uint32_t v) -> MeshComponent& {
      std::uint32_t& i = index[m_components.find(v)];
      if (i == kNoSide) {
        i = static_cast<std::uint32_t>(list.size());
        MeshComponent& added = list.emplace_back();
        added.closed = added.manifold = added.oriented = true;
      }
      return list[i];
    };
    const Eigen::Vector3d origin = m_report.low;
    for (const Triangle& t : m_clean.triangle) {
      MeshComponent& c = of(t[0]);
      ++c.triangles;
      c.area += vectorArea(m_clean, t).norm();
      c.volume += pyramid(t[0], t[1], m_clean.position[t[2]] - origin);
    }
    for (std::uint32_t v = 0; v < m_mesh.position.size(); ++v) {
      if (!m_used[v] || m_same[v] != v || index[m_components.find(v)] == kNoSide) continue;
      MeshComponent& c = of(v);
      ++c.vertices;
      if (m_crowded[v] || m_pinched[v]) c.manifold = false;
      if (m_twisted[v]) c.oriented = false;
    }
    for (std::size_t l = 0; l < m_loopSides.size(); ++l) {
      const BoundaryLoop& loop = m_report.boundaryLoops[l];
      MeshComponent& c = of(loop.vertex.front());
      c.closed = false;
      ++c.boundaryLoops;
      c.boundaryEdges += m_loopSides[l].size();
      for (const std::uint32_t s : m_loopSides[l])
        c.volume +=
            pyramid(endOf(m_clean.triangle, s), startOf(m_clean.triangle, s), loop.centre - origin);
    }
  }

  [[nodiscard]] double pyramid(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& c) const {
    return tetrahedronVolume(m_clean.position[a] - m_report.low, m_clean.position[b] - m_report.low,
                             c);
  }

  void conclude() {
    std::vector<MeshComponent>& list = m_report.components;
    m_report.closed = m_report.manifold = m_report.oriented = !list.empty();
    for (MeshComponent& c : list) {
      if (c.manifold && c.oriented) {
        // each edge has two triangles, or one on the boundary: 2 E = 3 F + B
        const auto twiceEdges = static_cast<std::int64_t>(3 * c.triangles + c.boundaryEdges);
        const std::int64_t euler =
            static_cast<std::int64_t>(c.vertices + c.triangles) - twiceEdges / 2;
        c.genus = (2 - static_cast<std::int64_t>(c.boundaryLoops) - euler) / 2;
      }
      m_report.closed &= c.closed;
      m_report.manifold &= c.manifold;
      m_report.oriented &= c.oriented;
      m_report.area += c.area;
      m_report.volume += c.volume;
    }
    std::stable_sort(list.begin(), list.end(), [](const MeshComponent& a, const MeshComponent& b) {
      return a.area > b.area;
    });
  }

  const TriangleMesh& m_mesh;
  TriangleMesh m_clean;
  MeshReport m_report;
  std::vector<std::uint32_t> m_same;
  std::vector<bool> m_used;
  std::vector<std::uint32_t> m_boundary;  // sides of edges that have one triangle
  std::vector<std::vector<std::uint32_t>> m_loopSides;
  std::vector<bool> m_crowded, m_pinched, m_twisted;  // by point
  DisjointSets m_corners, m_components;
};

}  // namespace

MeshReport diagnoseMesh(const TriangleMesh& mesh, const Progress& progress) {
  return Diagnosis(mesh).make(progress);
}

VesselSize vesselSize(const MeshReport& report) {
  return {report.area > 0 ? 2 * std::abs(report.volume) / report.area : 0,
          (report.high - report.low).norm()};
}

}  // namespace lumen::convert
