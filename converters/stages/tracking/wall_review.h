// SPDX-License-Identifier: Apache-2.0
// Review of the walls of a tracked vessel, with both neighbours of every node known
// (docs/method.md, section 1.11).
#pragma once

#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracked_tree.h"

namespace lumen::convert {

/// Nodes that are much wider than the vessel on both sides of them, by a poor fit, are fitted anew
/// with the radius that the sides let expect; where nothing fits, they are marked as bridged and
/// lose their points. Then vessels that are not round get their walls (wall_section.h). All other
/// nodes, and known branches, stay as they are.
void reviewWalls(const TrackContext& context, TrackedTree& tree);

}  // namespace lumen::convert
