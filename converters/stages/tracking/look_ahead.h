// SPDX-License-Identifier: Apache-2.0
// Beyond a place where nothing fits: local drops of intensity (docs/method.md, section 1.6).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// How a path goes on.
struct Continuation {
  std::size_t kept = 0;            ///< nodes of the path that stay
  std::vector<TrackedNode> found;  ///< the nodes after those; empty if there is no continuation
};

/// Where the next step from a path finds nothing: the nearest place ahead of its last node at which
/// two consecutive nodes fit as well as the vessel did so far. If there is none and `mayGiveUp`,
/// looks ahead from nodes before, since the last ones may have gone astray. Throws
/// Error(Cancelled).
Continuation findContinuation(const TrackContext& context, std::span<const TrackedNode> nodes,
                              bool mayGiveUp, Random& random, TrackWorkspace& workspace);

}  // namespace lumen::convert
