// SPDX-License-Identifier: Apache-2.0
// The thickness that a wall has.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/closing/thick_wall.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

/// Thicknesses at the vertices of the lumens' side, along the normal to the first surface that is
/// met: the outer one, or that of another lumen, where vessels share a wall.
struct WallThickness {
  static constexpr double kStep = 0.1;      ///< of `histogram`, as a share of that asked for
  std::array<std::size_t, 21> histogram{};  ///< vertices; the last: twice as thick, or more
  std::size_t measured = 0;                 ///< vertices in all
  double least = 0, median = 0;             ///< mm
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the least, mm, LPS
  /// A sentence for each pair of branches between whose lumens a shared wall is thinner than asked
  /// for; the thinnest first, at most five, then the number of further ones.
  std::vector<std::string> shared;
};

/// Measures a solid of thickWall(). Throws Error(Cancelled).
WallThickness measureWall(const CaseSurface& solid, const SeparatedField& field,
                          const Length& thickness, Progress& progress);

// Walls between touching vessels that are thinner than asked for.

/// A sentence for each pair of branches between which the wall whose outer surface is `outer` is
/// thinner than was asked, with the least thickness and its place, mm, LPS; the thinnest first, at
/// most five, then the number of further ones. Throws Error(Cancelled).
std::vector<std::string> thinWalls(const CaseSurface& outer, const OffsetField& field,
                                   Progress& progress);

}  // namespace lumen::convert
