// SPDX-License-Identifier: Apache-2.0
// Tracking of all vessels, parents before children, and the choice of the branch that keeps a
// stretch which two of them have tracked (docs/method.md, section 1.7).
#pragma once

#include <span>

#include "converters/base/progress.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/tracking/lumen_paths.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// Tracks every seed that is not known, all children of one depth at a time. These do not see one
/// another meanwhile, so that the result does not depend on threads. A child whose parent has no
/// track starts beside the nearest ancestor that has one, or as a root. Throws Error(Cancelled).
void trackByDepth(const TrackContext& context, TrackedTree& tree, Progress& progress);

// Conversion of tracks to trees: tips are extended as far as the lumen continues, gaps filled,
// children led to their parents (docs/method.md, section 1.12).

/// Extends all vessels from the ends at which they found nothing, as far as the lumen continues and
/// is not another vessel's. A stretch that two of them find belongs to the earlier one. Known
/// branches stay as they are. Throws Error(Cancelled).
void extendTips(const TrackContext& context, TrackedTree& tree);

/// Drops what is no vessel at the tips of all new vessels: domes, and nodes that turn back. The tips
/// of courses stay there, as these lead as far as the volume shows vessels: what a walk finds beyond
/// hangs on its random samples.
void trimTips(const TrackContext& context, TrackedTree& tree);

/// Makes one lumen of each tree: fills the gaps of all vessels, leads children to the axis of their
/// parents, and joins roots to another tree to which the lumen leads. Known branches, which are
/// joined already, stay as they are. Throws Error(Cancelled).
void joinTree(const TrackContext& context, TrackedTree& tree);

// Extension of tracks that have ended although the lumen goes on: at hairpins, kinks and forks
// (docs/method.md, section 1.12).

/// Extends a track that found no cylinder, turned back, or met another vessel: follows each path on
/// which the lumen continues, the straightest first, until one holds nodes like those before; from
/// there tracks as usual. `others`: lumen of other vessels. Writes the stop reason, and to `goesOn`
/// the length for which the lumen is seen to continue beyond the tip. Every round makes the track
/// longer, so that it ends. Throws Error(Cancelled).
void extendTip(TrackRun& run, TrackedBranch& branch, std::span<const WorldBall> others,
               FinishedBranches finished);

}  // namespace lumen::convert
