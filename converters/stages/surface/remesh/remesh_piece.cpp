// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh_piece.h"

#include "converters/stages/surface/remesh/remesh_moves.h"

namespace lumen::convert {
namespace {

constexpr int kIterations = 2;
constexpr int kLastRelaxations = 3;  // without a change of lengths

void remeshToTargets(RemeshMesh& mesh, bool isFirst, const Progress& progress) {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    progress.check();
    collapseShort(mesh);
    splitLong(mesh);
    flipToSix(mesh);
    relax(mesh);
    progress.check();
    moveOntoField(mesh, false);
    // Once: where the field has folds every edge leaves it, however short.
    if (isFirst && iteration == 0) refineSlits(mesh);
    mesh.garbage_collection();
  }
  for (int i = 0; i < kLastRelaxations; ++i) {
    progress.check();
    flipForAngles(mesh);
    relax(mesh);
    if (i + 1 < kLastRelaxations) moveOntoField(mesh, false);
  }
  progress.check();
  moveOntoField(mesh, true);
  flipForAngles(mesh);
}

}  // namespace

void remeshPiece(RemeshPiece& piece, const PieceRules& rules, PieceWork work,
                 const Progress& progress) {
  RemeshMesh mesh(piece, rules);
  if (work == PieceWork::Remesh || work == PieceWork::Seam)
    remeshToTargets(mesh, work == PieceWork::Remesh, progress);
  mendFaces(mesh, progress);
  if (work == PieceWork::Stretch) stretchFolds(mesh, progress);
  mesh.garbage_collection();
  piece = mesh.toPiece();
}

}  // namespace lumen::convert
