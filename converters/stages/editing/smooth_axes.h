// SPDX-License-Identifier: Apache-2.0
// Axes through the places where no wall was measured: forks, and where vessels touch (docs/method.md,
// section 1.14).
#pragma once

#include "converters/stages/editing/draft.h"

namespace lumen::convert {

/// Moves the bridged nodes of the vessels of a draft, and the places at which vessels leave their
/// parents; measured nodes stay.
///
/// - Bridged nodes between two measured ones of a branch lie on the curve along the directions of
///   both, unless that leads farther than a radius from where they were.
/// - A vessel leaves its parent, within twice the lesser radius of where it did, where the way from
///   axis to axis turns least; each radius of that way counts as a quarter radian. Its bridged
///   nodes before the first measured one lie on that way, outside of the parent's core.
void smoothAxes(Draft& draft);

}  // namespace lumen::convert
