// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/decimate.h"

#include <numeric>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "converters/stages/surface/collapses.h"
#include "converters/stages/surface/deviation.h"
#include "converters/stages/surface/remesh_pieces.h"

namespace lumen::convert {
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

void collapse(CaseSurface& surface, const SheetField& field, const CollapseBounds& bounds,
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

double decimate(CaseSurface& surface, const SheetField& field, const DecimateOptions& options,
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

void addCoarserLevels(std::vector<DetailLevel>& levels, int count, const SheetField& field,
                      Progress& progress) {
  while (static_cast<int>(levels.size()) < count) {
    CaseSurface next = levels.back().surface;
    collapse(next, field, {0, next.mesh.triangle.size() / 4}, progress);
    levels.push_back({std::move(next), -1});
  }
}

}  // namespace lumen::convert
