// SPDX-License-Identifier: Apache-2.0
// Walls between touching vessels that are thinner than asked for.
#pragma once

#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/offset_field.h"

namespace lumen::convert {

/// A sentence for each pair of branches between which the wall whose outer surface is `outer` is
/// thinner than was asked, with the least thickness and its place, mm, LPS; the thinnest first, at
/// most five, then the number of further ones. Throws Error(Cancelled).
std::vector<std::string> thinWalls(const CaseSurface& outer, const OffsetField& field,
                                   Progress& progress);

}  // namespace lumen::convert
