// SPDX-License-Identifier: Apache-2.0
// A wall with a thickness, as a solid.
#pragma once

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// Joins a lumen's surface and one around it, cut by cutEnds() in the same planes, to the closed
/// surface of the wall between them: the lumen's is turned over, and at each flat end the two rims
/// are joined by a flat ring. Groups: "wall" is the lumen's side, then "outer-wall", then the ends,
/// whose rings keep the lumen's names; round ends belong to the walls, and have no group. Its Euler
/// characteristic is the sum of both less two for each flat end. Throws Error(Failed) if the two do
/// not have the same ends, or if rims are not one within the other.
CaseSurface thickWall(const CaseSurface& inner, const CaseSurface& outer);

/// Moves vertices of `outer`, which follows `field`, outwards where its triangles pass through the
/// lumen's, in steps of a tenth of the thickness, ten times at most; the rims of flat ends stay.
/// Throws Error(Cancelled).
void liftOuter(const CaseSurface& inner, CaseSurface& outer, const SheetField& field,
               const Progress& progress);

}  // namespace lumen::convert
