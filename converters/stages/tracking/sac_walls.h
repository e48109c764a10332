// SPDX-License-Identifier: Apache-2.0
// Walls of aneurysms and of their necks, once all vessels are tracked and joined (docs/method.md,
// section 1.7).
#pragma once

#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

/// Gives the nodes of every new aneurysm the whole wall of its sac, lobes included, up to the
/// vessels that open into it. Nodes of these vessels in the sac or at its neck, known ones
/// included, get the wall that is nearest to them, and lose points within the lumen, which would be
/// a wall across it. An aneurysm that is joined to another is one sac with it; known aneurysms
/// bound the new ones. Where no sac is found, nodes keep the points that rays found. Throws
/// Error(Cancelled).
void captureSacs(const TrackContext& context, TrackedTree& tree);

}  // namespace lumen::convert
