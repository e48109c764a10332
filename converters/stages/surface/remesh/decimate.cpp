// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/decimate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <OpenMesh/Core/Geometry/QuadricT.hh>

#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/changing_triangles.h"
#include "converters/stages/surface/deviation.h"
#include "converters/stages/surface/remesh/remesh_pieces.h"

namespace lumen::convert {

namespace {

using Mesh = RemeshMesh;
using Quadric = OpenMesh::Geometry::Quadricd;

constexpr double kNoSharper = 0.067;  // squared sine of 15 degrees
constexpr int kCheckEvery = 256;      // collapses tried, about 10 ms

std::size_t indexOf(Mesh::VertexHandle v) {
  return static_cast<std::size_t>(v.idx());
}

std::uint32_t numberOf(Mesh::FaceHandle face) {
  return static_cast<std::uint32_t>(face.idx());
}

Triangle cornersOf(const Mesh& mesh, Mesh::FaceHandle face) {
  Triangle t{};
  const auto v = mesh.verticesOf(face);
  for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<std::uint32_t>(v[i].idx());
  return t;
}

TriangleMesh copyOf(const Mesh& mesh) {
  TriangleMesh copy;
  for (const Mesh::VertexHandle v : mesh.vertices()) copy.position.push_back(mesh.point(v));
  for (const Mesh::FaceHandle face : mesh.faces()) copy.triangle.push_back(cornersOf(mesh, face));
  return copy;
}

// The cost of a collapse, by M. Garland and P. Heckbert.
class Quadrics {
public:
  explicit Quadrics(const Mesh& mesh) : m_quadric(mesh.n_vertices()), m_area(mesh.n_vertices(), 0) {
    for (const Mesh::FaceHandle face : mesh.faces()) {
      const auto c = mesh.cornersOf(face);
      const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
      const double twice = normal.norm();
      if (!(twice > 0)) continue;
      const Eigen::Vector3d n = normal / twice;
      Quadric plane(n.x(), n.y(), n.z(), -n.dot(c[0]));
      plane *= twice / 2;
      for (const Mesh::VertexHandle v : mesh.verticesOf(face)) {
        m_quadric[indexOf(v)] += plane;
        m_area[indexOf(v)] += twice / 2;
      }
    }
  }

  // The root mean square distance of `at` from the planes of both vertices, mm.
  [[nodiscard]] double distance(Mesh::VertexHandle a, Mesh::VertexHandle b,
                                const Eigen::Vector3d& at) const {
    Quadric quadric = m_quadric[indexOf(a)];
    quadric += m_quadric[indexOf(b)];
    const double area = m_area[indexOf(a)] + m_area[indexOf(b)];
    const OpenMesh::Vec3d point(at.x(), at.y(), at.z());
    return area > 0 ? std::sqrt(std::max(0.0, quadric(point)) / area) : 0;
  }

  void merge(Mesh::VertexHandle gone, Mesh::VertexHandle kept) {
    m_quadric[indexOf(kept)] += m_quadric[indexOf(gone)];
    m_area[indexOf(kept)] += m_area[indexOf(gone)];
  }

private:
  std::vector<Quadric> m_quadric;
  std::vector<double> m_area;
};

class Collapses {
public:
  Collapses(Mesh& mesh, const CollapseBounds& bounds, const Progress& progress)
      : m_mesh(mesh),
        m_bounds(bounds),
        m_progress(progress),
        m_original(copyOf(mesh)),
        m_now(m_original),
        m_quadrics(mesh),
        m_tried(mesh.n_vertices(), 0),
        m_stamp(mesh.n_vertices(), 0) {
    for (const Mesh::VertexHandle v : mesh.vertices()) m_spacing.push_back(mesh.data(v).target);
    if (!(bounds.maxError > 0)) return;
    std::vector<std::uint32_t> group;
    std::vector<bool> isFlat;
    for (const Mesh::FaceHandle face : mesh.faces()) group.push_back(mesh.data(face).group);
    for (const auto& plane : mesh.rules().plane) isFlat.push_back(plane.has_value());
    m_deviation.emplace(m_original, group, isFlat, m_spacing);
  }

  void run() {
    std::size_t faces = m_original.triangle.size();
    for (const Mesh::VertexHandle v : m_mesh.vertices()) queue(v);
    for (int looks = 1; !m_queue.empty() && faces > m_bounds.triangles; ++looks) {
      if (looks % kCheckEvery == 0) m_progress.check();
      const Entry entry = m_queue.top();
      m_queue.pop();
      const Mesh::VertexHandle gone(entry.vertex);
      if (entry.stamp != m_stamp[indexOf(gone)] || m_mesh.status(gone).deleted()) continue;
      const Mesh::HalfedgeHandle h = candidates(gone)[m_tried[indexOf(gone)]].halfedge;
      if (!isAllowed(h)) {
        ++m_tried[indexOf(gone)];
        queue(gone);
        continue;
      }
      faces -= 2;
      collapse(h);
    }
  }

private:
  struct Candidate {
    double cost = 0;
    Mesh::HalfedgeHandle halfedge;
    bool operator<(const Candidate& other) const {
      return cost < other.cost || (cost == other.cost && halfedge.idx() < other.halfedge.idx());
    }
  };
  struct Entry {
    double cost = 0;
    int vertex = 0;
    std::uint32_t stamp = 0;
    bool operator>(const Entry& other) const {
      return cost > other.cost || (cost == other.cost && vertex > other.vertex);
    }
  };

  // The collapses that may remove a vertex, the cheapest first.
  [[nodiscard]] std::vector<Candidate> candidates(Mesh::VertexHandle gone) const {
    std::vector<Candidate> found;
    const VertexKind kind = m_mesh.data(gone).kind;
    if (kind == VertexKind::Locked) return found;
    const bool isBounded = m_bounds.maxError > 0;
    for (const Mesh::HalfedgeHandle h : m_mesh.voh_range(gone)) {
      if (kind == VertexKind::Rim && !m_mesh.data(m_mesh.edge_handle(h)).isRim) continue;
      const Mesh::VertexHandle kept = m_mesh.to_vertex_handle(h);
      const double distance = m_quadrics.distance(gone, kept, m_mesh.point(kept));
      if (isBounded && distance > m_bounds.maxError) continue;
      found.push_back({isBounded ? distance : distance / m_spacing[indexOf(gone)], h});
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  // Its next candidate waits for its turn.
  void queue(Mesh::VertexHandle v) {
    const std::vector<Candidate> found = candidates(v);
    const std::uint32_t tried = m_tried[indexOf(v)];
    if (tried < found.size()) m_queue.push({found[tried].cost, v.idx(), m_stamp[indexOf(v)]});
  }

  // The faces around the vertex that is removed, before and after.
  void findFaces(Mesh::HalfedgeHandle h) {
    const auto gone = static_cast<std::uint32_t>(m_mesh.from_vertex_handle(h).idx());
    const auto kept = static_cast<std::uint32_t>(m_mesh.to_vertex_handle(h).idx());
    m_before.clear();
    m_after.clear();
    for (const Mesh::FaceHandle face : m_mesh.vf_range(m_mesh.from_vertex_handle(h))) {
      m_before.push_back(numberOf(face));
      Triangle t = cornersOf(m_mesh, face);
      if (std::find(t.begin(), t.end(), kept) != t.end()) continue;
      std::replace(t.begin(), t.end(), gone, kept);
      m_after.push_back({numberOf(face), t, m_mesh.data(face).group});
    }
  }

  [[nodiscard]] bool isAllowed(Mesh::HalfedgeHandle h) {
    if (!m_mesh.mayCollapse(h)) return false;
    const Mesh::Outcome outcome = m_mesh.afterCollapse(h);
    if (outcome.isTurned || outcome.quality < std::min(outcome.before, kNoSharper)) return false;
    findFaces(h);
    if (m_deviation && !m_deviation->isWithin(m_bounds.maxError, m_before, m_after)) return false;
    return std::none_of(
               m_after.begin(), m_after.end(),
               [&](const GroupedFace& face) { return m_now.meets(face.corner, m_before); }) &&
           !areCrossed();
  }

  // Whether the new faces run through each other.
  [[nodiscard]] bool areCrossed() const {
    for (std::size_t i = 0; i < m_after.size(); ++i)
      for (std::size_t j = i + 1; j < m_after.size(); ++j)
        if (intersect(m_original, m_after[i].corner, m_after[j].corner)) return true;
    return false;
  }

  // Applies the collapse for which isAllowed() was called last.
  void collapse(Mesh::HalfedgeHandle h) {
    const Mesh::VertexHandle gone = m_mesh.from_vertex_handle(h), kept = m_mesh.to_vertex_handle(h);
    if (m_deviation) m_deviation->keep(m_before);
    m_mesh.collapse(h);
    m_quadrics.merge(gone, kept);
    for (const GroupedFace& face : m_after) m_now.change(face.index, face.corner);
    for (const std::uint32_t face : m_before)
      if (std::none_of(m_after.begin(), m_after.end(),
                       [&](const GroupedFace& after) { return after.index == face; }))
        m_now.remove(face);
    m_around.assign(1, kept);
    for (const Mesh::VertexHandle w : m_mesh.vv_range(kept)) m_around.push_back(w);
    for (const Mesh::VertexHandle w : m_around) {
      m_tried[indexOf(w)] = 0;
      ++m_stamp[indexOf(w)];
      queue(w);
    }
  }

  Mesh& m_mesh;
  const CollapseBounds& m_bounds;
  const Progress& m_progress;
  const TriangleMesh m_original;
  ChangingTriangles m_now;
  Quadrics m_quadrics;
  std::vector<double> m_spacing;
  std::optional<Deviation> m_deviation;
  std::vector<std::uint32_t> m_tried, m_stamp;  ///< candidates of each vertex; changes around it
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> m_queue;
  std::vector<std::uint32_t> m_before;
  std::vector<GroupedFace> m_after;
  std::vector<Mesh::VertexHandle> m_around;
};

}  // namespace

void collapseCheapest(RemeshMesh& mesh, const CollapseBounds& bounds, const Progress& progress) {
  if (mesh.n_faces() > 0) Collapses(mesh, bounds, progress).run();
}

namespace {

constexpr double kBoundShare = 0.98;  // share for sampled points; the rest is for places between
constexpr int kAttempts = 3;          // where that was not enough

// The outward direction, and the length of edges, at each vertex.
RemeshState makeState(CaseSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  const std::size_t vertices = mesh.position.size();
  RemeshState state{surface, std::vector<double>(vertices, 0), {}, {}, {}, {}, {}};
  state.gradient.assign(vertices, Eigen::Vector3d::Zero());
  state.isSeparated.assign(vertices, 0);
  state.isOffField.assign(vertices, 0);
  state.isBoundary.assign(vertices, 0);
  state.isKept.assign(vertices, 0);
  std::vector<double> edges(vertices, 0);
  for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
    const Triangle& t = mesh.triangle[f];
    const Eigen::Vector3d area = (mesh.position[t[1]] - mesh.position[t[0]])
                                     .cross(mesh.position[t[2]] - mesh.position[t[0]]);
    const bool isWall = surface.groups[surface.group[f]].kind == FaceKind::Wall;
    for (std::size_t i = 0; i < 3; ++i) {
      if (isWall) state.gradient[t[i]] += area;
      state.target[t[i]] += (mesh.position[t[(i + 1) % 3]] - mesh.position[t[i]]).norm();
      ++edges[t[i]];
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    state.gradient[v].normalize();
    if (edges[v] > 0) state.target[v] /= edges[v];
  }
  return state;
}

std::vector<bool> flatGroups(const CaseSurface& surface) {
  std::vector<bool> isFlat(surface.groups.size(), false);
  for (const SurfaceEnd& end : surface.ends)
    isFlat[end.group] = surface.groups[end.group].kind != FaceKind::Cap;
  return isFlat;
}

void collapse(CaseSurface& surface, const SeparatedField& field, const CollapseBounds& bounds,
              const Progress& progress) {
  RemeshState state = makeState(surface);
  const PieceRules rules = pieceRules(surface, field, progress);
  TriangleList all(surface.mesh.triangle.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<RemeshPiece> piece{cutOut(state, all)};
  RemeshMesh mesh(piece[0], rules);
  collapseCheapest(mesh, bounds, progress);
  mesh.garbage_collection();
  piece[0] = mesh.toPiece();
  putBack(state, std::span(&all, 1), piece);
}

}  // namespace

double distanceBetween(const CaseSurface& one, const CaseSurface& other) {
  return distanceBetween(one.mesh, one.group, other.mesh, other.group, flatGroups(one));
}

double decimate(CaseSurface& surface, const SeparatedField& field, const DecimateOptions& options,
                Progress& progress) {
  if (options.triangles >= surface.mesh.triangle.size() ||
      (options.triangles == 0 && !(options.maxError > 0)))
    return 0;
  const CaseSurface before = surface;
  double bound = kBoundShare * options.maxError;
  for (int attempt = 1;; ++attempt) {
    collapse(surface, field, {bound, options.triangles}, progress);
    progress.check();
    const double error = distanceBetween(surface, before);
    if (!(options.maxError > 0) || error <= options.maxError || attempt == kAttempts) return error;
    bound *= kBoundShare * options.maxError / error;
    surface = before;
  }
}

void addCoarserLevels(std::vector<DetailLevel>& levels, int count, const SeparatedField& field,
                      Progress& progress) {
  while (static_cast<int>(levels.size()) < count) {
    CaseSurface next = levels.back().surface;
    collapse(next, field, {0, next.mesh.triangle.size() / 4}, progress);
    levels.push_back({std::move(next), -1});
  }
}

}  // namespace lumen::convert
