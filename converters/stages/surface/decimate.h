// SPDX-License-Identifier: Apache-2.0
// Fewer triangles, with what that costs.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// When decimation ends: at whichever comes first.
struct DecimateOptions {
  double maxError = 0;        ///< mm, from the surface as it was; 0: no bound
  std::size_t triangles = 0;  ///< as few as this
};

/// Collapses edges in the order of M. Garland and P. Heckbert, Surface simplification using quadric
/// error metrics, 1997, where the surface stays within `maxError` of what it was, both ways, and runs
/// through itself nowhere where it did not (docs/method.md, section 5, Triangles). Topology, groups
/// and the planes of ends are kept; at least eight edges are left of a rim. Gives the measured
/// distance, mm. Throws Error(Cancelled).
double decimate(CaseSurface& surface, const SheetField& field, const DecimateOptions& options,
                Progress& progress);

/// The greatest distance between a surface and one that it was made from, both ways, mm, without flat
/// ends.
double distanceBetween(const CaseSurface& one, const CaseSurface& other);

/// A mesh of a surface, and how far it is from that with all triangles.
struct DetailLevel {
  CaseSurface surface;
  double error = -1;  ///< mm; negative: not measured
};

/// Adds levels to the one that is there until there are `count`: each has about a quarter of the
/// triangles of the one before, or as few as its topology, its rims and its neighbours allow. Throws
/// Error(Cancelled).
void addCoarserLevels(std::vector<DetailLevel>& levels, int count, const SheetField& field,
                      Progress& progress);

}  // namespace lumen::convert
