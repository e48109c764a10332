// SPDX-License-Identifier: Apache-2.0
// A wall with a thickness, as a solid.
#pragma once

#include "converters/stages/surface/case_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Joins a lumen's surface and one around it, cut by cutEnds() in the same planes, to the closed
/// surface of the wall between them: the lumen's is turned over, and at each flat end the two rims
/// are joined by a flat ring. Groups: "wall" is the lumen's side, then "outer-wall", then the ends,
/// whose rings keep the lumen's names; round ends belong to the walls, and have no group. Its Euler
/// characteristic is the sum of both less two for each flat end. Throws Error(Failed) if the two do
/// not have the same ends, if rims are not one within the other, or if both surfaces meet anywhere:
/// the sentence states the place and the count.
CaseSurface thickWall(const CaseSurface& inner, const CaseSurface& outer,
                      const formats::Case& source);

}  // namespace lumen::convert
