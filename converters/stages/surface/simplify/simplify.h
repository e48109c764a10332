// SPDX-License-Identifier: Apache-2.0
// A surface with as few triangles as its error allows, or as few as are asked for.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "converters/stages/surface/simplify/split_edges.h"
#include "converters/stages/surface/surface_options.h"

namespace lumen::convert {

/// Results of simplifyToField().
struct SimplifyReport {
  FieldError error;
  std::size_t crossings = 0;  ///< pairs of triangles that pass through each other
};

/// Gives a surface as marching made it, which does not intersect itself, few triangles: those that
/// lie within `allowed` of the field (docs/method.md, section 5, Triangles), or with an infinite
/// one, at most `triangles` of them. Vertices are collapsed while those that went stay near
/// (collapse_edges.h), then edges are split where the field bends away (split_edges.h); what would
/// make triangles pass through others is undone. The result is searched for such; where some are
/// left, the surface stays as it was given. Topology, groups and the planes of ends are kept.
/// Positions become floats. Throws Error(Cancelled).
SimplifyReport simplifyToField(CaseSurface& surface, const SeparatedField& field,
                               const SurfaceError& allowed, std::size_t triangles,
                               Progress& progress);

/// When simplify() ends: at whichever comes first.
struct SimplifyOptions {
  double maxError = 0;        ///< mm, from the given surface; 0: no bound
  std::size_t triangles = 0;  ///< ends at this number
};

/// Collapses edges of any surface of a case, its wall's included, without new crossings. Returns the
/// measured distance from the given one, mm, which is never above a bound: where it cannot be kept, the
/// surface stays as it is. Throws Error(Cancelled).
double simplify(CaseSurface& surface, const SimplifyOptions& options, Progress& progress);

/// The greatest distance between a surface and the one that it was made from, in both directions,
/// mm, without flat ends.
double distanceBetween(const CaseSurface& one, const CaseSurface& other);

/// A mesh of a surface, and its distance from the surface with all triangles.
struct DetailLevel {
  CaseSurface surface;
  double error = -1;  ///< mm; negative: not measured
};

/// Adds levels to the first one until there are `count`: each has about a quarter of the triangles
/// of its predecessor, or as few as its topology, its rims and its neighbours allow. Throws
/// Error(Cancelled).
void addCoarserLevels(std::vector<DetailLevel>& levels, int count, Progress& progress);

}  // namespace lumen::convert
