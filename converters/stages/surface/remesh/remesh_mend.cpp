// SPDX-License-Identifier: Apache-2.0
// The last sharp triangles, one by one.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/remesh/remesh_moves.h"

namespace lumen::convert {
namespace {

using Mesh = RemeshMesh;

constexpr double kMendBelow = 0.095;  // positions are rounded to floats when written
constexpr int kRounds = 6;
// Bounds on stretching where the field has no smooth surface, such as where it jumps from one model
// to the next.
constexpr int kStretchSteps = 30, kStretchRings = 6, kStretchPasses = 3;
constexpr double kLongestMade = 2;  // targets: a longer edge is no cure
constexpr double kGain = 1.0001;    // else it could go round in circles by rounding

// The vertices that changed, by the number of the change. An attempt at a face depends on its
// vertices and their neighbours alone, so it fails again as long as none of them has changed.
class Changes {
public:
  explicit Changes(const Mesh& mesh)
      : m_changed(mesh.n_vertices(), 0), m_attempt(mesh.n_faces(), 0) {}

  void mark(Mesh::VertexHandle v) { m_changed[index(v)] = m_now; }
  void markAround(const Mesh& mesh, Mesh::VertexHandle v) {
    mark(v);
    for (const Mesh::VertexHandle w : mesh.vv_range(v)) mark(w);
  }

  // Whether an attempt at the face may have another outcome than the last one; takes it as made.
  bool isDue(const Mesh& mesh, Mesh::FaceHandle face) {
    std::uint32_t& last = m_attempt[static_cast<std::size_t>(face.idx())];
    const std::uint32_t before = last;
    last = ++m_now;
    if (before == 0) return true;
    for (const Mesh::VertexHandle v : mesh.verticesOf(face)) {
      if (m_changed[index(v)] >= before) return true;
      for (const Mesh::VertexHandle w : mesh.vv_range(v))
        if (m_changed[index(w)] >= before) return true;
    }
    return false;
  }

private:
  static std::size_t index(Mesh::VertexHandle v) { return static_cast<std::size_t>(v.idx()); }

  std::vector<std::uint32_t> m_changed;  // number of the attempt that changed a vertex last
  std::vector<std::uint32_t> m_attempt;  // number of the last attempt at a face; 0: none
  std::uint32_t m_now = 0;
};

// Flips the edge of the face that helps most.
bool flipBest(Mesh& mesh, Mesh::FaceHandle face, Changes& changes) {
  std::optional<Mesh::EdgeHandle> best;
  double quality = 0;
  for (const Mesh::EdgeHandle edge : mesh.fe_range(face)) {
    if (!mesh.mayFlip(edge)) continue;
    const Mesh::Outcome outcome = mesh.afterFlip(edge);
    if (outcome.isTurned || outcome.quality <= kGain * outcome.before || outcome.quality <= quality)
      continue;
    quality = outcome.quality;
    best = edge;
  }
  if (!best) return false;
  mesh.flip(*best);
  const Mesh::HalfedgeHandle h = mesh.halfedge_handle(*best, 0);
  for (const Mesh::VertexHandle v : {mesh.from_vertex_handle(h), mesh.to_vertex_handle(h),
                                     mesh.opposite_vh(h), mesh.opposite_he_opposite_vh(h)})
    changes.mark(v);
  return true;
}

bool collapseBest(Mesh& mesh, Mesh::FaceHandle face, Changes& changes) {
  std::optional<Mesh::HalfedgeHandle> best;
  double quality = 0;
  for (const Mesh::HalfedgeHandle side : mesh.fh_range(face))
    for (const Mesh::HalfedgeHandle h : {side, mesh.opposite_halfedge_handle(side)}) {
      if (!mesh.mayCollapse(h)) continue;
      const Mesh::Outcome outcome = mesh.afterCollapse(h);
      if (outcome.isTurned || outcome.longest > kLongestMade ||
          outcome.quality <= kGain * outcome.before || outcome.quality <= quality)
        continue;
      quality = outcome.quality;
      best = h;
    }
  if (!best) return false;
  const Mesh::VertexHandle kept = mesh.to_vertex_handle(*best);
  mesh.collapse(*best);
  changes.markAround(mesh, kept);
  return true;
}

// Eight directions across the normal, in the plane of a flat end or along a rim.
std::vector<Eigen::Vector3d> directionsAt(const Mesh& mesh, Mesh::VertexHandle v) {
  const auto& here = mesh.data(v);
  std::vector<Eigen::Vector3d> directions;
  if (here.kind == VertexKind::Rim) {
    for (const Mesh::HalfedgeHandle h : mesh.voh_range(v))
      if (mesh.data(mesh.edge_handle(h)).isRim)
        directions.push_back(mesh.calc_edge_vector(h).normalized());
    return directions;
  }
  const bool isFlat = here.kind == VertexKind::Flat;
  const Eigen::Vector3d normal = isFlat ? *mesh.rules().plane[here.end] : here.gradient;
  if (normal.isZero()) return directions;
  const Eigen::Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
  for (const double a : {-1.0, 0.0, 1.0})
    for (const double b : {-1.0, 0.0, 1.0})
      if (a != 0 || b != 0) directions.push_back((a * u + b * w).normalized());
  return directions;
}

// Looks for a better place of one vertex, step by step, and takes it if it is better on the field.
void moveToBetter(Mesh& mesh, Mesh::VertexHandle v, Changes& changes) {
  const auto kept = mesh.data(v);
  const Eigen::Vector3d start = mesh.point(v);
  if (kept.kind == VertexKind::Locked) return;
  std::vector<Mesh::StarFace> star;
  mesh.gatherStar(v, star);
  const double before = mesh.starQuality(star, start);
  const auto directions = directionsAt(mesh, v);
  Eigen::Vector3d place = start;
  double quality = before;
  for (double step = 0.4 * kept.target; step > 0.02 * kept.target; step *= 0.5) {
    const Eigen::Vector3d from = place;
    for (const Eigen::Vector3d& direction : directions) {
      const Eigen::Vector3d there = from + step * direction;
      const double q = mesh.starQuality(star, there, kGain * quality);
      if (q <= kGain * quality || !mesh.mayMove(star, start, there)) continue;
      quality = q;
      place = there;
    }
  }
  if (place == start) return;
  mesh.set_point(v, place);
  if (kept.kind != VertexKind::Flat) settle(mesh, v);
  mesh.gatherStar(v, star);
  if (mesh.starQuality(star, mesh.point(v)) > kGain * before) return changes.mark(v);
  mesh.set_point(v, start);
  mesh.data(v) = kept;
}

void mendFace(Mesh& mesh, Mesh::FaceHandle face, Changes& changes) {
  if (flipBest(mesh, face, changes) || collapseBest(mesh, face, changes)) return;
  for (const Mesh::VertexHandle v : mesh.verticesOf(face)) moveToBetter(mesh, v, changes);
}

// Faces at the boundary are left to the piece that has them inside.
bool needsMending(const Mesh& mesh, Mesh::FaceHandle face) {
  for (const Mesh::VertexHandle v : mesh.verticesOf(face))
    if (mesh.is_boundary(v)) return false;
  return mesh.measureQuality(face) < kMendBelow;
}

std::vector<Mesh::FaceHandle> facesToMend(const Mesh& mesh) {
  std::vector<Mesh::FaceHandle> bad;
  for (const Mesh::FaceHandle face : mesh.faces())
    if (needsMending(mesh, face)) bad.push_back(face);
  return bad;
}

// The wall's vertices within some rings of the faces, in the order of their handles.
std::vector<Mesh::VertexHandle> wallAround(const Mesh& mesh,
                                           const std::vector<Mesh::FaceHandle>& faces, int rings) {
  std::vector<std::uint8_t> marked(mesh.n_vertices(), 0);
  const auto mark = [&](Mesh::VertexHandle v) -> std::uint8_t& {
    return marked[static_cast<std::size_t>(v.idx())];
  };
  for (const Mesh::FaceHandle face : faces)
    for (const Mesh::VertexHandle v : mesh.verticesOf(face)) mark(v) = 1;
  for (int ring = 1; ring <= rings; ++ring)
    for (const Mesh::VertexHandle v : mesh.vertices()) {
      if (mark(v) != ring) continue;
      for (const Mesh::VertexHandle w : mesh.vv_range(v))
        if (mark(w) == 0) mark(w) = static_cast<std::uint8_t>(ring + 1);
    }
  std::vector<Mesh::VertexHandle> found;
  for (const Mesh::VertexHandle v : mesh.vertices())
    if (mark(v) != 0 && mesh.data(v).kind == VertexKind::Wall) found.push_back(v);
  return found;
}

// Takes vertices off the field and stretches the wall between the others like a membrane.
void stretch(Mesh& mesh, const std::vector<Mesh::VertexHandle>& vertices) {
  for (int step = 0; step < kStretchSteps; ++step)
    for (const Mesh::VertexHandle v : vertices) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double count = 0;
      for (const Mesh::VertexHandle w : mesh.vv_range(v)) {
        sum += mesh.point(w);
        ++count;
      }
      mesh.set_point(v, sum / count);
    }
  for (const Mesh::VertexHandle v : vertices) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const Mesh::FaceHandle face : mesh.vf_range(v)) {
      const auto c = mesh.cornersOf(face);
      normal += (c[1] - c[0]).cross(c[2] - c[0]);
    }
    if (normal.norm() > 0) mesh.data(v).gradient = normal.normalized();
    mesh.data(v).isOffField = true;
  }
}

}  // namespace

void mendFaces(RemeshMesh& mesh, const Progress& progress) {
  std::size_t before = std::numeric_limits<std::size_t>::max();
  Changes changes(mesh);
  for (int round = 0; round < kRounds; ++round) {
    progress.check();
    const auto bad = facesToMend(mesh);
    if (bad.empty() || bad.size() > before) return;
    before = bad.size();
    bool isAnyDue = false;
    for (const Mesh::FaceHandle face : bad) {
      progress.check();
      if (mesh.status(face).deleted() || !needsMending(mesh, face) || !changes.isDue(mesh, face))
        continue;
      isAnyDue = true;
      mendFace(mesh, face, changes);
    }
    if (!isAnyDue) return;
  }
}

void stretchFolds(RemeshMesh& mesh, const Progress& progress) {
  for (int rings = 2; rings <= kStretchRings; ++rings) {
    const auto bad = facesToMend(mesh);
    if (bad.empty()) return;
    stretch(mesh, wallAround(mesh, bad, rings));
    for (int i = 0; i < kStretchPasses; ++i) {
      collapseShort(mesh);
      splitLong(mesh);
      flipForAngles(mesh);
      relax(mesh);
    }
    mendFaces(mesh, progress);
  }
}

}  // namespace lumen::convert
