// SPDX-License-Identifier: Apache-2.0
// Aneurysms are not tubes: their wall points come from the clicks alone (docs/method.md,
// section 1.7; Yureidini's thesis, 3.7).
#pragma once

#include <optional>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// A node around a click with the wall points that rays find, but for direction and height; empty
/// if no ray meets a wall.
std::optional<TrackedNode> sacNodeAt(const TrackContext& context, const SeedPoint& click,
                                     TrackWorkspace& workspace);

/// Directions and heights of a chain of at least two nodes: those of the way to the next node; the
/// last repeats the one before.
void alignWithChain(std::vector<TrackedNode>& nodes);

/// Wall points of an aneurysm from its ordered centres, all of which have a radius. `parent`, which
/// may be null, is what the chain hangs on, by the end that is nearer to it.
TrackedBranch captureAneurysm(const TrackContext& context, const SeedBranch& seed,
                              const TrackedBranch* parent);

}  // namespace lumen::convert
