// SPDX-License-Identifier: Apache-2.0
// Triangles where the surface is too far from its field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

/// Distances of a surface from its field, mm, at vertices and in the middles of edges and
/// triangles, without those of flat ends.
struct FieldError {
  double greatest = 0, ninetieth = 0;
  std::size_t places = 0;  ///< number of them
  std::size_t beyond = 0;  ///< places that are farther off than allowed, as where the field jumps
};

/// A chord of length c of a circle of radius r is c^2 / 8 r away in its middle, and two thirds of that
/// on average: greatest distance of a chord, in allowed errors.
constexpr double kChordShare = 1.5;

/// The greatest distance of a chord from the wall that leaves a surface within `allowed` after
/// splitFarEdges(), mm: that of chords between vertices on the wall, which then are moved out of it
/// by two thirds. Vessels that touch stay inside of their walls.
double chordAt(const SeparatedField& field, std::uint32_t node, const SurfaceError& allowed);

/// Splits the edges of the wall whose middles, or those of their triangles, are farther from the
/// field than chordAt(), and puts the new vertices onto the field; up to four times. Then moves
/// vertices out of the wall until the triangles around them lie as far outside as inside: a
/// polygon whose corners are on a circle has less area. Edges of a rim are split in the plane of their
/// end. Edges whose middles would turn triangles over stay, and vertices whose triangles would pass
/// through others, of those that are `isClose` by triangle, stay or become the middles of their
/// edges. Throws Error(Cancelled).
FieldError splitFarEdges(CaseSurface& surface, const SeparatedField& field,
                         const SurfaceError& allowed, std::vector<std::uint8_t>& isClose,
                         Progress& progress);

/// The distances of a surface from its field as they are.
FieldError fieldErrorOf(CaseSurface& surface, const SeparatedField& field,
                        const SurfaceError& allowed, Progress& progress);

}  // namespace lumen::convert
