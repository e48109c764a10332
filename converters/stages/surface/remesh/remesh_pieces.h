// SPDX-License-Identifier: Apache-2.0
// A surface in pieces that threads remesh at the same time, and whole again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/remesh/remesh_piece.h"

namespace lumen::convert {

/// A surface with remeshing's data of each vertex.
struct RemeshState {
  CaseSurface& surface;
  std::vector<double> target;  ///< as PieceVertex has it, and so on
  std::vector<Eigen::Vector3d> gradient;
  std::vector<std::uint8_t> isSeparated, isOffField, isBoundary;
  std::vector<std::uint8_t> isKept = {};  ///< no triangle at such a vertex is changed
};

/// The rules of a surface: which of its groups are flat.
PieceRules pieceRules(const CaseSurface& surface, const SeparatedField& field,
                      const Progress& progress);

using TriangleList = std::vector<std::uint32_t>;

/// Divides all triangles by ranges of cursor nodes into pieces of about 20 000, fewer if there
/// would be less than eight pieces. The division depends on the surface alone, never on threads.
std::vector<TriangleList> piecesByNode(const CaseSurface& surface);

/// The triangles within `rings` rings of the marked vertices, connected ones in the same piece.
std::vector<TriangleList> piecesAround(const TriangleMesh& mesh, std::vector<std::uint8_t> marked,
                                       int rings);

/// Copies triangles out as a piece. Those at a vertex where the piece would be no manifold are
/// taken off the list and left alone.
RemeshPiece cutOut(const RemeshState& state, TriangleList& triangles);

/// Puts pieces in the place of the triangles that were cut out as them.
void putBack(RemeshState& state, std::span<const TriangleList> triangles,
             std::span<const RemeshPiece> pieces);

}  // namespace lumen::convert
