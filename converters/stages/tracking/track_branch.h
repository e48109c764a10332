// SPDX-License-Identifier: Apache-2.0
// One vessel, from its clicks to its ends (docs/method.md, sections 1.5 to 1.7).
#pragma once

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Tracks one vessel. `parent` may be null; the track ends where it runs into one of `finished`.
/// Throws Error(Cancelled).
TrackedBranch trackBranch(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent,
                          FinishedBranches finished);

}  // namespace lumen::convert
