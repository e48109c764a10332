// SPDX-License-Identifier: Apache-2.0
// Straight tubes in front of inlets and behind outlets.
#pragma once

#include <string>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/length.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Extends flat ends by tubes along their normals. A length in radii refers to those of the
/// opening, the radius of the circle of its area. Within 1.5 radii of the rim the section changes
/// into this circle, on a Hermite curve that leaves along the wall's tangent there; then the tube
/// is straight. Sides belong to group 0, and the end's flat faces close the tube; their triangles
/// have edges about as long as the rim's. `ends` of the surface move along. Returns a sentence for
/// each tube that runs into the surface or another tube, and for each length whose branch has no
/// flat end. Throws Error(Usage) if a label is not in the case or comes twice, Error(InvalidInput)
/// if a tube needs more triangles than fit.
std::vector<std::string> extendEnds(CaseSurface& surface, const formats::Case& source,
                                    const std::vector<EndLength>& lengths);

/// Extends all flat ends by one length, but those whose tube would run into the surface or into
/// another tube: these stay as they are.
void extendFreeEnds(CaseSurface& surface, const formats::Case& source, const Length& length);

}  // namespace lumen::convert
