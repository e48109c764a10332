// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/remesh_pieces.h"

namespace lumen::convert {
namespace {

constexpr int kSeamRings = 5;  // reach of the unevenness at a boundary that could not move
constexpr int kMendRings = 4;
constexpr int kWholeRings = 10;  // six may leave the field
constexpr int kStretchRounds = 2;
constexpr double kMendWholeBelow = 1.2 * kSharpAngle;  // as in each piece
constexpr std::size_t kVertexBatch = 1024;             // vertices between two looks at the progress
constexpr double kFarthestStep = 0.5;                  // radii: more is no distance from the wall

// Samples the field at every vertex, and moves those of the wall by one step onto it.
void moveOntoField(RemeshState& state, const PieceRules& rules) {
  CaseSurface& surface = state.surface;
  std::vector<std::uint8_t> isFlat(surface.mesh.position.size(), 0);
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (rules.plane[surface.group[t]])
      for (const std::uint32_t v : surface.mesh.triangle[t]) isFlat[v] = 1;
  tbb::parallel_for(std::size_t{0}, isFlat.size(), [&](std::size_t v) {
    if (v % kVertexBatch == 0) rules.progress.check();
    Eigen::Vector3d& position = surface.mesh.position[v];
    const SheetSample sample = rules.field.at(position, surface.node[v]);
    if (sample.gradient.isZero()) return;
    state.gradient[v] = sample.gradient;
    state.isSeparated[v] = sample.isSeparated ? 1 : 0;
    if (isFlat[v] != 0) return;
    const double longest = kFarthestStep * rules.field.radius(sample.node);
    position -= std::clamp(sample.distance, -longest, longest) * sample.gradient;
    surface.node[v] = sample.node;
  });
}

// Works on pieces at the same time.
void workOn(RemeshState& state, std::vector<TriangleList> lists, const PieceRules& rules,
            PieceWork work, Progress& progress) {
  std::vector<RemeshPiece> pieces(lists.size());
  const auto workOnPiece = [&](std::size_t i) {
    progress.check();
    pieces[i] = cutOut(state, lists[i]);
    remeshPiece(pieces[i], rules, work, progress);
    progress.advance();
  };
  tbb::parallel_for(std::size_t{0}, lists.size(), workOnPiece, tbb::simple_partitioner());
  progress.check();
  putBack(state, lists, pieces);
}

double leastCornerAngle(const TriangleMesh& mesh, const Triangle& t) {
  return leastAngle(mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]);
}

// The corners of triangles that are sharp, or face into the lumen.
std::vector<std::uint8_t> sharpVertices(const RemeshState& state, const PieceRules& rules) {
  const TriangleMesh& mesh = state.surface.mesh;
  std::vector<std::uint8_t> sharp(mesh.position.size(), 0);
  for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
    const Triangle& t = mesh.triangle[f];
    const auto &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
    const auto& plane = rules.plane[state.surface.group[f]];
    const Eigen::Vector3d outward =
        plane ? *plane
              : Eigen::Vector3d(state.gradient[t[0]] + state.gradient[t[1]] + state.gradient[t[2]]);
    if (leastAngle(a, b, c) < kMendWholeBelow || (b - a).cross(c - a).dot(outward) < 0)
      sharp[t[0]] = sharp[t[1]] = sharp[t[2]] = 1;
  }
  return sharp;
}

RemeshReport makeReport(const RemeshState& state, const PieceRules& rules) {
  RemeshReport report;
  const CaseSurface& surface = state.surface;
  std::vector<std::uint8_t> isOff = state.isOffField;
  for (std::size_t t = 0; t < surface.group.size(); ++t) {
    if (leastCornerAngle(surface.mesh, surface.mesh.triangle[t]) < kSharpAngle) ++report.sharp;
    if (rules.plane[surface.group[t]])
      for (const std::uint32_t v : surface.mesh.triangle[t]) isOff[v] = 0;
  }
  report.offField = static_cast<std::size_t>(std::count(isOff.begin(), isOff.end(), 1));
  return report;
}

}  // namespace

RemeshReport remesh(CaseSurface& surface, const SheetField& field, const EdgeLength& edge,
                    Progress& progress) {
  const PieceRules rules = pieceRules(surface, field, progress);
  const std::size_t vertices = surface.mesh.position.size();
  RemeshState state{surface, targetLengths(surface, field, edge), {}, {}, {}, {}};
  state.gradient.assign(vertices, Eigen::Vector3d::Zero());
  state.isSeparated.assign(vertices, 0);
  state.isOffField.assign(vertices, 0);
  moveOntoField(state, rules);
  // Vertices that no piece holds inside are boundary as well.
  state.isBoundary.assign(vertices, 1);
  std::vector<TriangleList> pieces = piecesByNode(surface);
  progress.begin("remeshing", pieces.size());
  workOn(state, std::move(pieces), rules, PieceWork::Remesh, progress);
  progress.end();
  workOn(state, piecesAround(surface.mesh, state.isBoundary, kSeamRings), rules, PieceWork::Seam,
         progress);
  workOn(state, piecesAround(surface.mesh, sharpVertices(state, rules), kMendRings), rules,
         PieceWork::Mend, progress);
  for (int round = 0; round < kStretchRounds; ++round)
    workOn(state, piecesAround(surface.mesh, sharpVertices(state, rules), kWholeRings), rules,
           PieceWork::Stretch, progress);
  return makeReport(state, rules);
}

}  // namespace lumen::convert
