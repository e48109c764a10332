// SPDX-License-Identifier: Apache-2.0
// The last sharp triangles, one by one.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "converters/surface/remesh_moves.h"
#include "converters/surface/triangle_quality.h"

namespace lumen::convert {
namespace {

using Mesh = RemeshMesh;

constexpr double kMendBelow = 0.095;  // positions are rounded to floats when written
constexpr int kRounds = 12;
constexpr int kSplits = 2;
constexpr double kLongestMade = 2;  // of the target: a longer edge is no cure
constexpr double kGain = 1.0001;    // else it could go round in circles by rounding

// Flips the edge of the face that helps most.
bool flipBest(Mesh& mesh, Mesh::FaceHandle face) {
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
  if (best) mesh.flip(*best);
  return best.has_value();
}

bool collapseBest(Mesh& mesh, Mesh::FaceHandle face) {
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
  if (best) mesh.collapseEdge(*best);
  return best.has_value();
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
bool moveToBetter(Mesh& mesh, Mesh::VertexHandle v) {
  const auto kept = mesh.data(v);
  const Eigen::Vector3d start = mesh.point(v);
  if (kept.kind == VertexKind::Locked) return false;
  const double before = mesh.starQuality(v, start);
  const auto directions = directionsAt(mesh, v);
  Eigen::Vector3d place = start;
  double quality = before;
  for (double step = 0.4 * kept.target; step > 0.02 * kept.target; step *= 0.5) {
    const Eigen::Vector3d from = place;
    for (const Eigen::Vector3d& direction : directions) {
      const Eigen::Vector3d there = from + step * direction;
      const double q = mesh.starQuality(v, there);
      if (q <= kGain * quality || !mesh.mayMove(v, there)) continue;
      quality = q;
      place = there;
    }
  }
  if (place == start) return false;
  mesh.set_point(v, place);
  if (kept.kind != VertexKind::Flat) settle(mesh, v);
  if (mesh.starQuality(v, mesh.point(v)) > kGain * before) return true;
  mesh.set_point(v, start);
  mesh.data(v) = kept;
  return false;
}

bool mendFace(Mesh& mesh, Mesh::FaceHandle face) {
  if (flipBest(mesh, face) || collapseBest(mesh, face)) return true;
  bool moved = false;
  for (const Mesh::VertexHandle v : mesh.verticesOf(face)) moved |= moveToBetter(mesh, v);
  return moved;
}

// Faces at the boundary are left to the piece that has them inside.
bool needsMending(const Mesh& mesh, Mesh::FaceHandle face) {
  for (const Mesh::VertexHandle v : mesh.verticesOf(face))
    if (mesh.is_boundary(v)) return false;
  return mesh.qualityOf(face) < kMendBelow;
}

// Where nothing else helps: a new vertex on the longest edge gives the others more freedom.
void splitLongest(Mesh& mesh, Mesh::FaceHandle face) {
  Mesh::EdgeHandle longest;
  for (const Mesh::EdgeHandle edge : mesh.fe_range(face))
    if (!longest.is_valid() || mesh.lengthOf(edge) > mesh.lengthOf(longest)) longest = edge;
  if (mesh.is_boundary(longest) || mesh.data(longest).isRim) return;
  const Mesh::VertexHandle v = mesh.splitEdge(longest);
  if (mesh.data(v).kind == VertexKind::Wall) settle(mesh, v);
}

}  // namespace

void mendFaces(RemeshMesh& mesh, const Progress& progress) {
  for (int round = 0, splits = 0; round < kRounds; ++round) {
    progress.check();
    std::vector<Mesh::FaceHandle> bad;
    for (const Mesh::FaceHandle face : mesh.faces())
      if (needsMending(mesh, face)) bad.push_back(face);
    if (bad.empty()) return;
    bool any = false;
    for (const Mesh::FaceHandle face : bad)
      if (!mesh.status(face).deleted() && needsMending(mesh, face)) any |= mendFace(mesh, face);
    if (any) continue;
    if (++splits > kSplits) return;
    for (const Mesh::FaceHandle face : bad)
      if (needsMending(mesh, face)) splitLongest(mesh, face);
  }
}

}  // namespace lumen::convert
