// SPDX-License-Identifier: Apache-2.0
// Hollows within a solid.
#pragma once

#include <cstddef>

#include "converters/stages/surface/case_surface.h"

namespace lumen::convert {

/// Drops the connected parts of a closed surface that look inwards: hollows within others. Returns
/// their number. O(v + t).
std::size_t dropHollows(CaseSurface& surface);

}  // namespace lumen::convert
