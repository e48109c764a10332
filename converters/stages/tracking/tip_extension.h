// SPDX-License-Identifier: Apache-2.0
// Extension of tracks that have ended although the lumen goes on: at hairpins, kinks and forks
// (docs/method.md, section 1.12).
#pragma once

#include <span>

#include "converters/stages/tracking/lumen_paths.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Extends a track that found no cylinder, turned back, or met another vessel: follows each path on
/// which the lumen continues, the straightest first, until one holds nodes like those before; from
/// there tracks as usual. `others`: lumen of other vessels. Writes the stop reason, and to `goesOn`
/// the length for which the lumen is seen to continue beyond the tip. Every round makes the track
/// longer, so that it ends. Throws Error(Cancelled).
void extendTip(TrackRun& run, TrackedBranch& branch, std::span<const WorldBall> others,
               FinishedBranches finished);

}  // namespace lumen::convert
