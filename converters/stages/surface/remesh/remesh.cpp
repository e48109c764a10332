// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "converters/geometry/triangle_quality.h"
#include "converters/stages/surface/remesh/remesh_pieces.h"

namespace lumen::convert {
namespace {

constexpr int kSeamRings = 5;  // reach of the unevenness at a boundary that could not move
constexpr int kMendRings = 4;
constexpr int kWholeRings = 10;  // six may leave the field
constexpr int kStretchRounds = 2;
constexpr double kMendWholeBelow = 0.0954915028125263;  // squared sine of 18 degrees, as in pieces
constexpr std::size_t kVertexBatch = 1024;  // vertices between two looks at the progress
constexpr double kFarthestStep = 0.5;       // radii: more is no distance from the wall

// Whether a triangle stays as it is.
bool isKeptTriangle(const RemeshState& state, std::uint32_t t) {
  const Triangle& corner = state.surface.mesh.triangle[t];
  return state.isKept[corner[0]] != 0 || state.isKept[corner[1]] != 0 ||
         state.isKept[corner[2]] != 0;
}

// The vertices of triangles that stay as they are, or of flat ends as well.
std::vector<std::uint8_t> stayingVertices(const RemeshState& state, const PieceRules& rules,
                                          bool withEnds) {
  const CaseSurface& surface = state.surface;
  std::vector<std::uint8_t> stays(surface.mesh.position.size(), 0);
  for (std::uint32_t t = 0; t < surface.group.size(); ++t)
    if ((withEnds && rules.plane[surface.group[t]]) || isKeptTriangle(state, t))
      for (const std::uint32_t v : surface.mesh.triangle[t]) stays[v] = 1;
  return stays;
}

// Samples the field at every vertex, and moves those of the wall by one step onto it.
void moveOntoField(RemeshState& state, const PieceRules& rules) {
  CaseSurface& surface = state.surface;
  const std::vector<std::uint8_t> stays = stayingVertices(state, rules, true);
  tbb::parallel_for(std::size_t{0}, stays.size(), [&](std::size_t v) {
    if (v % kVertexBatch == 0) rules.progress.check();
    Eigen::Vector3d& position = surface.mesh.position[v];
    const SeparatedSample sample = rules.field.at(position, surface.node[v]);
    if (sample.gradient.isZero()) return;
    state.gradient[v] = sample.gradient;
    state.isSeparated[v] = sample.isSeparated ? 1 : 0;
    if (stays[v] != 0) return;
    const double longest = kFarthestStep * rules.field.radius(sample.node);
    position -= std::clamp(sample.distance, -longest, longest) * sample.gradient;
    surface.node[v] = sample.node;
  });
}

// Works on pieces at the same time, but for those that are in `made`; returns them.
std::vector<RemeshPiece> makePieces(const RemeshState& state, std::vector<TriangleList>& lists,
                                    const PieceRules& rules, PieceWork work,
                                    std::vector<const RemeshPiece*> made, Progress& progress) {
  made.resize(lists.size(), nullptr);
  std::vector<RemeshPiece> pieces(lists.size());
  const auto workOnPiece = [&](std::size_t i) {
    progress.check();
    if (made[i] != nullptr) {
      pieces[i] = *made[i];
    } else {
      std::erase_if(lists[i], [&](std::uint32_t t) { return isKeptTriangle(state, t); });
      pieces[i] = cutOut(state, lists[i]);
      remeshPiece(pieces[i], rules, work, progress);
    }
    progress.advance();
  };
  tbb::parallel_for(std::size_t{0}, lists.size(), workOnPiece, tbb::simple_partitioner());
  progress.check();
  return pieces;
}

void workOn(RemeshState& state, std::vector<TriangleList> lists, const PieceRules& rules,
            PieceWork work, Progress& progress) {
  if (lists.empty()) return;
  progress.begin(work == PieceWork::Seam ? "seams" : "sharp triangles", lists.size());
  const auto pieces = makePieces(state, lists, rules, work, {}, progress);
  putBack(state, lists, pieces);
  progress.end();
}

// The pieces of an earlier run that are the same now, since no vertex of theirs stays: null for
// the others.
std::vector<const RemeshPiece*> unchangedPieces(const RemeshState& state, const PieceRules& rules,
                                                const std::vector<TriangleList>& lists,
                                                const std::vector<RemeshPiece>& before) {
  if (before.empty()) return {};
  const std::vector<std::uint8_t> stays = stayingVertices(state, rules, false);
  std::vector<const RemeshPiece*> same(lists.size(), nullptr);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const bool isTouched = std::ranges::any_of(lists[i], [&](std::uint32_t t) {
      return std::ranges::any_of(state.surface.mesh.triangle[t],
                                 [&](std::uint32_t v) { return stays[v] != 0; });
    });
    if (!isTouched) same[i] = &before[i];
  }
  return same;
}

// The corners of triangles that are sharp, or face into the lumen.
std::vector<std::uint8_t> sharpVertices(const RemeshState& state, const PieceRules& rules) {
  const TriangleMesh& mesh = state.surface.mesh;
  std::vector<std::uint8_t> isBad(mesh.triangle.size());
  tbb::parallel_for(std::size_t{0}, isBad.size(), [&](std::size_t f) {
    const Triangle& t = mesh.triangle[f];
    const auto &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
    const auto& plane = rules.plane[state.surface.group[f]];
    const Eigen::Vector3d outward =
        plane ? *plane
              : Eigen::Vector3d(state.gradient[t[0]] + state.gradient[t[1]] + state.gradient[t[2]]);
    isBad[f] =
        squaredSine(a, b, c) < kMendWholeBelow || (b - a).cross(c - a).dot(outward) < 0 ? 1 : 0;
  });
  std::vector<std::uint8_t> sharp(mesh.position.size(), 0);
  for (std::size_t f = 0; f < isBad.size(); ++f)
    if (isBad[f] != 0)
      for (const std::uint32_t v : mesh.triangle[f]) sharp[v] = 1;
  return sharp;
}

RemeshReport makeReport(const RemeshState& state, const PieceRules& rules) {
  RemeshReport report;
  const CaseSurface& surface = state.surface;
  std::vector<std::uint8_t> isOff = state.isOffField, isSharp(surface.group.size());
  tbb::parallel_for(std::size_t{0}, isSharp.size(), [&](std::size_t t) {
    const auto& [a, b, c] = surface.mesh.triangle[t];
    const auto& p = surface.mesh.position;
    isSharp[t] = squaredSine(p[a], p[b], p[c]) < kSharpSquaredSine ? 1 : 0;
  });
  report.sharp = static_cast<std::size_t>(std::count(isSharp.begin(), isSharp.end(), 1));
  for (std::size_t t = 0; t < surface.group.size(); ++t)
    if (rules.plane[surface.group[t]])
      for (const std::uint32_t v : surface.mesh.triangle[t]) isOff[v] = 0;
  report.offField = static_cast<std::size_t>(std::count(isOff.begin(), isOff.end(), 1));
  return report;
}

}  // namespace

RemeshReport RepeatedRemesh::run(const std::vector<std::uint8_t>& isKept, CaseSurface& surface) {
  surface = m_surface;
  const PieceRules rules = pieceRules(surface, m_field, m_progress);
  const std::size_t vertices = surface.mesh.position.size();
  RemeshState state{surface, targetLengths(surface, m_field, m_edge), {}, {}, {}, {}, isKept};
  state.gradient.assign(vertices, Eigen::Vector3d::Zero());
  state.isSeparated.assign(vertices, 0);
  state.isKept.resize(vertices, 0);
  state.isOffField = state.isKept;
  moveOntoField(state, rules);
  // Vertices that no piece holds inside are boundary as well.
  state.isBoundary.assign(vertices, 1);
  // The division of the first run: what stays has other nodes afterwards.
  if (m_division.empty()) m_division = piecesByNode(surface);
  std::vector<TriangleList> lists = m_division;
  m_progress.begin("remeshing", lists.size());
  const auto unchanged = unchangedPieces(state, rules, lists, m_made);
  for (std::size_t i = 0; i < unchanged.size(); ++i)
    if (unchanged[i] != nullptr) lists[i] = m_cutOut[i];
  std::vector<RemeshPiece> pieces =
      makePieces(state, lists, rules, PieceWork::Remesh, unchanged, m_progress);
  putBack(state, lists, pieces);
  m_progress.end();
  if (isKept.empty()) {
    m_made = std::move(pieces);
    m_cutOut = std::move(lists);
  }
  workOn(state, piecesAround(surface.mesh, state.isBoundary, kSeamRings), rules, PieceWork::Seam,
         m_progress);
  workOn(state, piecesAround(surface.mesh, sharpVertices(state, rules), kMendRings), rules,
         PieceWork::Mend, m_progress);
  for (int round = 0; round < kStretchRounds; ++round)
    workOn(state, piecesAround(surface.mesh, sharpVertices(state, rules), kWholeRings), rules,
           PieceWork::Stretch, m_progress);
  return makeReport(state, rules);
}

RemeshReport remesh(CaseSurface& surface, const SeparatedField& field, const EdgeLength& edge,
                    Progress& progress) {
  const CaseSurface given = surface;
  return RepeatedRemesh(given, field, edge, progress).run({}, surface);
}

}  // namespace lumen::convert
