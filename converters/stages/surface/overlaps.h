// SPDX-License-Identifier: Apache-2.0
// Where vessels overlap.
#pragma once

#include <vector>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/closed_surface.h"
#include "converters/stages/surface/sheet_field.h"

namespace lumen::convert {

/// The pairs of branches whose walls the surface keeps apart although the field's would overlap,
/// the deepest first.
std::vector<Overlap> overlapsOf(const CaseSurface& surface, const SheetField& field);

}  // namespace lumen::convert
