// SPDX-License-Identifier: Apache-2.0
// What fitting a straight cylinder to a bent vessel does to its centerline (docs/method.md, section
// 1.10).
#pragma once

#include <vector>

#include "converters/stages/tracking/tracked_branch.h"

namespace lumen::convert {

/// Moves centres back onto the axis of a bent vessel. A straight cylinder through the wall of a
/// vessel of curvature k lies by k <w^2> / 2 to the inner side of the bend, where <w^2> is the mean
/// square of its wall points' places along its axis. The curvature is that of the circle through
/// the node and the nearest ones on either side that are at least its height away; nodes without
/// such neighbours stay, and none moves by more than a tenth of its radius.
void correctBends(std::vector<TrackedNode>& nodes);

}  // namespace lumen::convert
