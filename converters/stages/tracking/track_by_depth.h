// SPDX-License-Identifier: Apache-2.0
// Tracking of all vessels, parents before children, and the choice of the branch that keeps a
// stretch which two of them have tracked (docs/method.md, section 1.7).
#pragma once

#include "converters/base/progress.h"
#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

/// Tracks every seed that is not known, all children of one depth at a time. These do not see one
/// another meanwhile, so that the result does not depend on threads. A child whose parent has no
/// track starts beside the nearest ancestor that has one, or as a root. Throws Error(Cancelled).
void trackByDepth(const TrackContext& context, TrackedTree& tree, Progress& progress);

}  // namespace lumen::convert
