// SPDX-License-Identifier: Apache-2.0
// Stretches of vessels that a surface leaves out.
#pragma once

#include <string>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A sentence for each stretch of a branch, longer than four radii, around which the surface has no
/// wall: no vertex whose cursor is at one of its nodes, and none of any vessel within two radii of
/// its middle. Places in mm, LPS. O(v + n) for v vertices and n nodes, and O(v) for each stretch.
std::vector<std::string> bareStretches(const CaseSurface& surface,
                                       const formats::CenterlineTree& tree);

}  // namespace lumen::convert
