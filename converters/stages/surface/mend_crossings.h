// SPDX-License-Identifier: Apache-2.0
// Repair of crossings between walls of vessels, where triangles are too coarse for the gap between
// them.
#pragma once

#include "converters/base/progress.h"
#include "converters/geometry/self_intersections.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// Moves the triangles that pass through others back into their own lumens, in steps of a quarter
/// of the gap or of a fiftieth of the radius, whichever is more, until none does, or eight times.
/// Vertices of flat ends stay where they are. Returns the pairs that still intersect. After the first
/// search only triangles near those that were moved are looked at. Throws Error(Cancelled).
SelfIntersections mendCrossings(CaseSurface& surface, const SheetField& field, Progress& progress);

}  // namespace lumen::convert
