// SPDX-License-Identifier: Apache-2.0
// Estimation and prediction steps in turn (docs/method.md, section 1.5; Yureidini's thesis,
// algorithm 1).
#pragma once

#include <span>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Appends nodes to a branch that has some, until a stop rule holds (thesis section 3.5), which it
/// writes to the branch. `finished` are the branches that end this one when it runs into them; the
/// track may then lose nodes that it had. Throws Error(Cancelled).
void followVessel(const TrackContext& context, TrackedBranch& branch,
                  std::span<const TrackedBranch* const> finished, Random& random,
                  TrackWorkspace& workspace);

/// The nodes from `goal` to `start`, in that order, by tracking from `start` against its direction;
/// `start` alone if that does not lead to `goal`, or not by a way that is straight enough to be
/// believed.
std::vector<TrackedNode> trackBack(const TrackContext& context, const TrackedNode& start,
                                   const TrackedBranch& goal, Random& random,
                                   TrackWorkspace& workspace);

}  // namespace lumen::convert
