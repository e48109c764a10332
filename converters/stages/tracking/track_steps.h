// SPDX-License-Identifier: Apache-2.0
// Estimation and prediction steps in turn, and the bridges over local drops of intensity
// (docs/method.md, sections 1.5 and 1.6; Yureidini's thesis, algorithm 1).
#pragma once

#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Appends nodes to a branch that has some until a stop rule holds (thesis section 3.5), and writes
/// that rule to the branch. The track may lose nodes that it had. Throws Error(Cancelled).
void trackToEnd(TrackRun& run, TrackedBranch& branch, FinishedBranches finished);

/// The nodes from `goal` to `start`, in that order, by tracking from `start` against its direction;
/// `start` alone if this does not lead to `goal`, or along an implausibly long path.
std::vector<TrackedNode> trackBackTo(TrackRun& run, const TrackedNode& start,
                                     const TrackedBranch& goal);

/// Steps that a track must reach from its start; in noise it goes on for one or two.
constexpr int kTrialSteps = 4;
/// The number of steps, at most kTrialSteps, that a track from a node which was fitted to a guess
/// goes on outside of the lumen of `parent`, which may be null.
int trialSteps(TrackRun& run, const TrackedNode& start, const TrackedBranch* parent);

// One vessel, from its clicks to its ends (docs/method.md, sections 1.5 to 1.7).

/// Tracks one vessel. `parent` may be null; the track ends where it runs into one of `finished`.
/// Throws Error(Cancelled).
TrackedBranch trackBranch(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent,
                          FinishedBranches finished);

}  // namespace lumen::convert
