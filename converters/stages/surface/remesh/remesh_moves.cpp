// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh_moves.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

namespace lumen::convert {
namespace {

using Mesh = RemeshMesh;

// The thresholds of M. Botsch and L. Kobbelt, A remeshing approach to multiresolution modeling,
// 2004: a split or a collapse brings an edge nearer to its target.
constexpr double kLong = 4.0 / 3.0, kShort = 4.0 / 5.0;
constexpr int kSplitSweeps = 4;        // each halves: enough for edges of sixteen targets
constexpr double kRelaxation = 0.8;    // share of the distance to the middle
constexpr double kLongestMove = 0.5;   // targets, in one step
constexpr double kSmallMove = 0.01;    // targets: not worth a look at the faces around
constexpr double kDrift = 0.05;        // targets: a smaller move leaves the surface by 2e-5 r
constexpr double kFieldStep = 0.3;     // radii: farther off, f is not straight
constexpr double kChordInSlit = 0.25;  // gaps
constexpr double kFinest = 0.2;        // share of the target, at a slit
constexpr double kLargestSag = 0.25;   // share of an edge
constexpr double kFlipQuality = 0.25;  // flips for valence leave no angle under 30 degrees, unless
                                       // it was there before

std::optional<Eigen::Vector3d> planeOf(const Mesh& mesh, Mesh::VertexHandle v) {
  const auto& here = mesh.data(v);
  return here.end == 0 ? std::nullopt : mesh.rules().plane[here.end];
}

// Target of the relaxation of a vertex on a rim: the middle of its two neighbours along it.
Eigen::Vector3d rimTarget(const Mesh& mesh, Mesh::VertexHandle v) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const Mesh::HalfedgeHandle h : mesh.voh_range(v)) {
    if (!mesh.data(mesh.edge_handle(h)).isRim) continue;
    sum += mesh.point(mesh.to_vertex_handle(h));
    ++count;
  }
  return count == 2 ? Eigen::Vector3d(sum / 2) : mesh.point(v);
}

Eigen::Vector3d faceTarget(const std::vector<Mesh::StarFace>& star, const Eigen::Vector3d& here) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (const Mesh::StarFace& face : star) {
    const Eigen::Vector3d out = face.a - here, next = face.b - here;
    const double weight = out.cross(next).norm() / (face.target * face.target);
    sum += weight / 3 * (out + next);
    weights += weight;
  }
  return weights > 0 ? Eigen::Vector3d(here + sum / weights) : here;
}

// Moves a vertex as far as no face turns: fully, by half, by a quarter, or not at all.
void moveTowards(Mesh& mesh, Mesh::VertexHandle v, const std::vector<Mesh::StarFace>& star,
                 Eigen::Vector3d move) {
  const Eigen::Vector3d here = mesh.point(v);
  for (int attempt = 0; attempt < 3; ++attempt, move *= 0.5) {
    const Eigen::Vector3d position = here + move;
    if (!mesh.mayMove(star, here, position)) continue;
    mesh.set_point(v, position);
    mesh.data(v).drift += move.norm();
    return;
  }
}

void take(Mesh& mesh, Mesh::VertexHandle v, const SeparatedSample& sample) {
  auto& here = mesh.data(v);
  if (!sample.gradient.isZero()) here.gradient = sample.gradient;
  here.node = sample.node;
  here.isSeparated = sample.isSeparated;
}

void stepOntoField(Mesh& mesh, Mesh::VertexHandle v) {
  if (mesh.data(v).isOffField) return;
  const SeparatedField& field = mesh.rules().field;
  const SeparatedSample sample = field.at(mesh.point(v), mesh.data(v).node);
  if (sample.gradient.isZero()) return;
  const double longest = kFieldStep * field.radius(sample.node);
  const double distance = std::clamp(sample.distance, -longest, longest);
  mesh.set_point(v, mesh.point(v) - distance * sample.gradient);
  take(mesh, v, sample);
  mesh.data(v).drift = 0;
}

// The change of a vertex' squared difference of its valence from six; 0 on the boundary, where it
// is unknown.
int changeOfError(const Mesh& mesh, Mesh::VertexHandle v, int change) {
  return mesh.is_boundary(v) ? 0 : change * (2 * (mesh.data(v).valence - 6) + change);
}

// True if the angles across an edge sum up to at most 180 degrees; else the other diagonal is
// better.
bool isDelaunay(const Mesh& mesh, Mesh::EdgeHandle edge) {
  const Mesh::HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
  const auto &a = mesh.point(mesh.from_vertex_handle(h)), &b = mesh.point(mesh.to_vertex_handle(h));
  const auto &c = mesh.point(mesh.opposite_vh(h)), &d = mesh.point(mesh.opposite_he_opposite_vh(h));
  const Eigen::Vector3d ca = a - c, cb = b - c, da = a - d, db = b - d;
  return ca.dot(cb) * da.cross(db).norm() + da.dot(db) * ca.cross(cb).norm() >= 0;
}

}  // namespace

// The longest first: in another order, thin triangles can breed long edges for ever. A split changes
// no edge but those that it makes, of which one half keeps the handle.
void splitLong(RemeshMesh& mesh) {
  std::vector<std::pair<double, int>> tooLong, next;
  const auto look = [&](Mesh::EdgeHandle edge) {
    mesh.pulse();
    const double share = mesh.lengthOf(edge) / mesh.targetOf(edge);
    if (share > kLong && !mesh.is_boundary(edge)) next.emplace_back(-share, edge.idx());
  };
  for (const Mesh::EdgeHandle edge : mesh.edges()) look(edge);
  for (int sweep = 0; !next.empty() && sweep < kSplitSweeps; ++sweep) {
    tooLong.swap(next);
    next.clear();
    std::sort(tooLong.begin(), tooLong.end());
    const auto made = static_cast<int>(mesh.n_edges());
    for (const auto& [share, edge] : tooLong) {
      mesh.pulse();
      mesh.splitEdge(Mesh::EdgeHandle(edge));
    }
    if (sweep + 1 == kSplitSweeps) return;
    for (const auto& [share, edge] : tooLong) look(Mesh::EdgeHandle(edge));
    for (int edge = made; edge < static_cast<int>(mesh.n_edges()); ++edge)
      look(Mesh::EdgeHandle(edge));
  }
}

void collapseShort(RemeshMesh& mesh) {
  for (std::size_t i = 0; i < mesh.n_edges(); ++i) {
    mesh.pulse();
    const Mesh::EdgeHandle edge(static_cast<int>(i));
    if (mesh.status(edge).deleted() || mesh.is_boundary(edge) ||
        mesh.lengthOf(edge) >= kShort * mesh.targetOf(edge))
      continue;
    std::optional<Mesh::HalfedgeHandle> best;
    double quality = -1;
    for (const unsigned side : {0U, 1U}) {
      const Mesh::HalfedgeHandle h = mesh.halfedge_handle(edge, side);
      if (mesh.makesLonger(h, kLong) || !mesh.mayCollapse(h)) continue;
      const Mesh::Outcome outcome = mesh.afterCollapse(h);
      if (outcome.isTurned || outcome.quality <= quality) continue;
      quality = outcome.quality;
      best = h;
    }
    if (best) mesh.collapse(*best);
  }
}

void flipToSix(RemeshMesh& mesh) {
  for (const Mesh::VertexHandle v : mesh.vertices()) mesh.data(v).valence = 0;
  for (const Mesh::EdgeHandle edge : mesh.edges())
    for (const unsigned side : {0U, 1U})
      ++mesh.data(mesh.to_vertex_handle(mesh.halfedge_handle(edge, side))).valence;
  for (const Mesh::EdgeHandle edge : mesh.edges()) {
    mesh.pulse();
    if (mesh.is_boundary(edge)) continue;
    const Mesh::HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
    const Mesh::VertexHandle from = mesh.from_vertex_handle(h), to = mesh.to_vertex_handle(h),
                             left = mesh.opposite_vh(h), right = mesh.opposite_he_opposite_vh(h);
    if (changeOfError(mesh, from, -1) + changeOfError(mesh, to, -1) + changeOfError(mesh, left, 1) +
                changeOfError(mesh, right, 1) >=
            0 ||
        !mesh.mayFlip(edge))
      continue;
    const Mesh::Outcome outcome = mesh.afterFlip(edge);
    if (outcome.isTurned || outcome.quality < std::min(outcome.before, kFlipQuality)) continue;
    mesh.flip(edge);
    for (const Mesh::VertexHandle v : {from, to}) --mesh.data(v).valence;
    for (const Mesh::VertexHandle v : {left, right}) ++mesh.data(v).valence;
  }
}

void flipForAngles(RemeshMesh& mesh) {
  for (const Mesh::EdgeHandle edge : mesh.edges()) {
    mesh.pulse();
    if (mesh.is_boundary(edge) || isDelaunay(mesh, edge) || !mesh.mayFlip(edge)) continue;
    const Mesh::Outcome outcome = mesh.afterFlip(edge);
    if (!outcome.isTurned && outcome.quality > outcome.before) mesh.flip(edge);
  }
}

void relax(RemeshMesh& mesh) {
  std::vector<Mesh::StarFace> star;
  for (const Mesh::VertexHandle v : mesh.vertices()) {
    mesh.pulse();
    const auto& here = mesh.data(v);
    if (here.kind == VertexKind::Locked) continue;
    mesh.gatherStar(v, star);
    Eigen::Vector3d move;
    if (here.kind == VertexKind::Rim) {
      move = kRelaxation * (rimTarget(mesh, v) - mesh.point(v));
    } else {
      const auto plane = planeOf(mesh, v);
      const Eigen::Vector3d normal = plane ? *plane : here.gradient;
      move = kRelaxation * (faceTarget(star, mesh.point(v)) - mesh.point(v));
      move -= move.dot(normal) * normal;
    }
    const double length = move.norm(), longest = kLongestMove * here.target;
    if (length < kSmallMove * here.target) continue;
    if (length > longest) move *= longest / length;
    moveTowards(mesh, v, star, move);
  }
}

bool settle(RemeshMesh& mesh, RemeshMesh::VertexHandle v) {
  auto& here = mesh.data(v);
  if (here.isOffField) return false;
  const auto plane = here.kind == VertexKind::Rim ? planeOf(mesh, v) : std::nullopt;
  const auto foot = mesh.rules().field.project(mesh.point(v), here.node, plane ? &*plane : nullptr);
  here.isOffField = !foot;
  if (!foot) return false;
  mesh.set_point(v, foot->position);
  take(mesh, v, foot->sample);
  here.drift = 0;
  return true;
}

void moveOntoField(RemeshMesh& mesh, bool exactly) {
  for (const Mesh::VertexHandle v : mesh.vertices()) {
    mesh.pulse();
    auto& here = mesh.data(v);
    if (here.kind == VertexKind::Locked || here.kind == VertexKind::Flat) continue;
    if (exactly || (here.kind == VertexKind::Rim && here.drift > 0))
      settle(mesh, v);
    else if (here.drift > kDrift * here.target)
      stepOntoField(mesh, v);
  }
}

void refineSlits(RemeshMesh& mesh) {
  const SeparatedField& field = mesh.rules().field;
  const double allowed = kChordInSlit * field.options().gap;
  if (!(allowed > 0)) return;
  for (const Mesh::EdgeHandle edge : mesh.edges()) {
    mesh.pulse();
    const Mesh::HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
    const Mesh::VertexHandle from = mesh.from_vertex_handle(h), to = mesh.to_vertex_handle(h);
    if (!mesh.data(from).isSeparated && !mesh.data(to).isSeparated) continue;
    if (mesh.data(from).kind == VertexKind::Flat || mesh.data(to).kind == VertexKind::Flat)
      continue;
    const SeparatedSample middle =
        field.at(0.5 * (mesh.point(from) + mesh.point(to)), mesh.data(from).node);
    // Splitting helps only where the surface lies behind the edge and is near enough.
    const double sag = middle.distance, length = mesh.lengthOf(edge);
    if (!(sag > allowed) || sag > kLargestSag * length) continue;
    // The sag of a chord grows with the square of its length.
    const double wanted = length * std::max(kFinest, std::sqrt(allowed / sag));
    for (const Mesh::VertexHandle v : {from, to}) {
      if (mesh.data(v).kind == VertexKind::Locked || mesh.data(v).target <= wanted) continue;
      mesh.data(v).target = wanted;
    }
  }
}

}  // namespace lumen::convert
