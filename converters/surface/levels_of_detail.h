// SPDX-License-Identifier: Apache-2.0
// One surface as several meshes, from fine to coarse.
#pragma once

#include <vector>

#include "converters/surface/decimate.h"

namespace lumen::convert {

/// A mesh of a surface, and how far it is from the field.
struct DetailLevel {
  CaseSurface surface;
  SurfaceError error;
};

/// `count` levels, of which the first is `surface` itself and each next has about a quarter of the
/// triangles of the one before, or as few as its topology and rims allow. Throws Error(Cancelled).
std::vector<DetailLevel> levelsOfDetail(CaseSurface surface, const SheetField& field,
                                        std::size_t count, Progress& progress);

}  // namespace lumen::convert
