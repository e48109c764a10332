// SPDX-License-Identifier: Apache-2.0
// Whether the volume has edges where vessels that were found have their walls (docs/method.md,
// section 1.13).
#pragma once

#include <vector>

#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_branch.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

/// Leaves of each new vessel the first stretch along which the volume has its wall, and nothing of
/// one that has none: bone, metal and texture let cylinders fit, but their edges lie at random.
/// Returns the further stretches of each branch, by its place. The result does not depend on the
/// number of threads. Throws Error(Cancelled).
std::vector<std::vector<TrackedBranch>> takeWithoutEdges(const TrackContext& context,
                                                         TrackedTree& tree);

}  // namespace lumen::convert
