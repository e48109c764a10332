// SPDX-License-Identifier: Apache-2.0
// Where vessels that touch leave less room than their walls need.
#pragma once

#include <string>
#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/offset_field.h"

namespace lumen::convert {

/// A sentence for each pair of branches between which the wall whose outer surface is `outer` is
/// thinner than was asked, with the least thickness and its place, mm, LPS; the thinnest first, five
/// at most, then how many more there are.
std::vector<std::string> thinWalls(const CaseSurface& outer, const OffsetField& field);

}  // namespace lumen::convert
