// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/decimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <tbb/parallel_for.h>

// First the mesh, whose headers QuadricT.hh needs and does not include.
// clang-format off
#include "converters/surface/remesh_mesh.h"
#include <OpenMesh/Core/Geometry/QuadricT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
// clang-format on

#include "converters/surface/remesh_moves.h"
#include "converters/surface/remesh_pieces.h"
#include "converters/surface/remesh_target.h"
#include "converters/surface/surface_error.h"

namespace lumen::convert {
namespace {

using Quadric = OpenMesh::Geometry::Quadricd;

constexpr double kNoSharper = 0.067;   // squared sine of 15 degrees
constexpr double kQuadricShare = 0.5;  // of the bound: the rest is for what planes do not see
constexpr int kRefinements = 8;        // each divides the error by about four
constexpr int kCheckEvery = 4096;      // collapses looked at, about 10 ms

// What a collapse costs: the root mean square distance of the vertex that stays from the planes
// of the faces that went into it, mm or in targets.
class CollapseCost : public OpenMesh::Decimater::ModBaseT<RemeshMesh> {
public:
  using Base = OpenMesh::Decimater::ModBaseT<RemeshMesh>;
  using Handle = OpenMesh::Decimater::ModHandleT<CollapseCost>;
  using CollapseInfo = Base::CollapseInfo;
  DECIMATER_MODNAME(CollapseCost)
  explicit CollapseCost(RemeshMesh& mesh) : Base(mesh, false) {}

  void setUp(double largest, const Progress& progress) {
    m_largest = largest;
    m_progress = &progress;
  }

  void initialize() override {
    m_quadric.assign(mesh().n_vertices(), Quadric());
    m_area.assign(mesh().n_vertices(), 0);
    for (const RemeshMesh::FaceHandle face : mesh().faces()) {
      const auto c = mesh().cornersOf(face);
      const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
      const double twice = normal.norm();
      if (!(twice > 0)) continue;
      const Eigen::Vector3d n = normal / twice;
      Quadric plane(n.x(), n.y(), n.z(), -n.dot(c[0]));
      plane *= twice / 2;
      for (const RemeshMesh::VertexHandle v : mesh().verticesOf(face)) {
        m_quadric[indexOf(v)] += plane;
        m_area[indexOf(v)] += twice / 2;
      }
    }
  }

  float collapse_priority(const CollapseInfo& info) override {
    if (++m_looks % kCheckEvery == 0) m_progress->check();
    Quadric quadric = m_quadric[indexOf(info.v0)];
    quadric += m_quadric[indexOf(info.v1)];
    const double area = m_area[indexOf(info.v0)] + m_area[indexOf(info.v1)];
    const OpenMesh::Vec3d point(info.p1.x(), info.p1.y(), info.p1.z());
    const double error = std::sqrt(std::max(0.0, quadric(point)) / area);
    if (m_largest > 0 && error > m_largest) return ILLEGAL_COLLAPSE;
    if (!mesh().mayCollapse(info.v0v1)) return ILLEGAL_COLLAPSE;
    const RemeshMesh::Outcome outcome = mesh().afterCollapse(info.v0v1);
    if (outcome.isTurned || outcome.quality < std::min(outcome.before, kNoSharper))
      return ILLEGAL_COLLAPSE;
    return static_cast<float>(m_largest > 0 ? error : error / mesh().data(info.v0).target);
  }

  void postprocess_collapse(const CollapseInfo& info) override {
    m_quadric[indexOf(info.v1)] += m_quadric[indexOf(info.v0)];
    m_area[indexOf(info.v1)] += m_area[indexOf(info.v0)];
  }

private:
  static std::size_t indexOf(RemeshMesh::VertexHandle v) {
    return static_cast<std::size_t>(v.idx());
  }
  std::vector<Quadric> m_quadric;
  std::vector<double> m_area;  ///< of the faces that went into it
  double m_largest = 0;
  const Progress* m_progress = nullptr;
  int m_looks = 0;
};

RemeshState stateOf(CaseSurface& surface, const SheetField& field) {
  const std::size_t vertices = surface.mesh.position.size();
  RemeshState state{surface, targetLengths(surface, field, {}), {}, {}, {}, {}};
  state.gradient.resize(vertices);
  state.isSeparated.assign(vertices, 0);
  state.isOffField.assign(vertices, 0);
  state.isBoundary.assign(vertices, 0);
  tbb::parallel_for(std::size_t{0}, vertices, [&](std::size_t v) {
    state.gradient[v] = field.at(surface.mesh.position[v], surface.node[v]).gradient;
  });
  return state;
}

void collapseCheapest(RemeshMesh& mesh, const DecimateOptions& options, const Progress& progress) {
  OpenMesh::Decimater::DecimaterT<RemeshMesh> decimater(mesh);
  OpenMesh::Decimater::ModHandleT<CollapseCost> cost;
  decimater.add(cost);
  decimater.module(cost).setUp(kQuadricShare * options.maxError, progress);
  if (!decimater.initialize()) return;
  decimater.decimate_to_faces(0, options.triangles);
}

// Halves the edges that are too far from the field, and the longest of faces that are.
bool refineWhereFar(RemeshMesh& mesh, double maxError) {
  const SheetField& field = mesh.rules().field;
  const auto isFar = [&](const Eigen::Vector3d& point, RemeshMesh::VertexHandle v) {
    return distanceToField(field, point, mesh.data(v).node) > maxError;
  };
  std::vector<RemeshMesh::EdgeHandle> far;
  for (const RemeshMesh::EdgeHandle edge : mesh.edges()) {
    const RemeshMesh::HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
    const RemeshMesh::VertexHandle v = mesh.from_vertex_handle(h);
    if (mesh.isInPlane(edge) && !mesh.data(edge).isRim) continue;
    if (isFar(0.5 * (mesh.point(v) + mesh.point(mesh.to_vertex_handle(h))), v)) far.push_back(edge);
  }
  for (const RemeshMesh::FaceHandle face : mesh.faces()) {
    if (mesh.rules().plane[mesh.data(face).group]) continue;
    const auto c = mesh.cornersOf(face);
    if (isFar((c[0] + c[1] + c[2]) / 3, mesh.verticesOf(face)[0]))
      far.push_back(mesh.longestOf(face));
  }
  std::sort(far.begin(), far.end());
  far.erase(std::unique(far.begin(), far.end()), far.end());
  for (const RemeshMesh::EdgeHandle edge : far) {
    const RemeshMesh::VertexHandle v = mesh.splitEdge(edge);
    if (mesh.data(v).kind != VertexKind::Flat) settle(mesh, v);
  }
  return !far.empty();
}

}  // namespace

SurfaceError decimate(CaseSurface& surface, const SheetField& field, const DecimateOptions& options,
                      Progress& progress) {
  if (options.triangles >= surface.mesh.triangle.size() ||
      (options.triangles == 0 && !(options.maxError > 0)))
    return surfaceError(surface, field);
  RemeshState state = stateOf(surface, field);
  const PieceRules rules = rulesOf(surface, field);
  TriangleList all(surface.mesh.triangle.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<Piece> piece{cutOut(state, all)};
  RemeshMesh mesh(piece[0], rules);
  collapseCheapest(mesh, options, progress);
  mesh.garbage_collection();
  for (int i = 0; i < kRefinements && options.maxError > 0; ++i) {
    progress.check();
    if (!refineWhereFar(mesh, options.maxError)) break;
  }
  piece[0] = mesh.toPiece();
  putBack(state, std::span(&all, 1), piece);
  return surfaceError(surface, field);
}

}  // namespace lumen::convert
