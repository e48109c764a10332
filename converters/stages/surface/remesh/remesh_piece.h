// SPDX-License-Identifier: Apache-2.0
// A part of a surface that is remeshed by itself, while its boundary stays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/surface/separated_field.h"

namespace lumen::convert {

constexpr std::uint32_t kNewVertex = 0xFFFFFFFF;

/// A vertex of a piece.
struct PieceVertex {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< unit, of the field; zero if unknown
  double target = 0;                                   ///< length that edges should have here, mm
  std::uint32_t node = 0;                              ///< node of its cursor
  std::uint32_t home = kNewVertex;                     ///< its index in the whole surface
  bool isSeparated = false;                            ///< see SeparatedSample::isSeparated
  bool isOffField = false;                             ///< the field had no surface near by
  bool isBoundary = false;                             ///< on the boundary, so not touched
};

/// A manifold with boundary. Vertices of the boundary are not touched, and no edge is made between
/// two of them, so that pieces which share them can be put together again.
struct RemeshPiece {
  std::vector<PieceVertex> vertex;
  std::vector<Triangle> triangle;    ///< indices into `vertex`
  std::vector<std::uint32_t> group;  ///< group of each triangle
};

/// Data that all pieces of a surface share.
struct PieceRules {
  const SeparatedField& field;
  const Progress& progress;  ///< checked by long loops for cancelling
  /// For each group, the unit normal of its plane if it is a flat end.
  std::vector<std::optional<Eigen::Vector3d>> plane;
};

enum class PieceWork : std::uint8_t {
  Remesh,  ///< to the target lengths, which become shorter in slits
  Seam,    ///< to the target lengths, where slits have theirs
  Mend,    ///< only triangles that are sharp or folded
  Stretch  ///< and those that Mend leaves, off the field
};

/// Remeshes a piece in place; vertices that vanish are removed, new ones are at the end.
void remeshPiece(RemeshPiece& piece, const PieceRules& rules, PieceWork work,
                 const Progress& progress);

}  // namespace lumen::convert
