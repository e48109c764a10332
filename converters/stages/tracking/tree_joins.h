// SPDX-License-Identifier: Apache-2.0
// Conversion of tracks to trees: tips are extended as far as the lumen continues, gaps filled,
// children led to their parents (docs/method.md, section 1.12).
#pragma once

#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
