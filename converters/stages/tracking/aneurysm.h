// SPDX-License-Identifier: Apache-2.0
// Aneurysms are not tubes: their wall points come from the clicks alone (docs/method.md,
// section 1.7; Yureidini's thesis, 3.7).
#pragma once

#include <optional>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_run.h"

namespace lumen::convert {

/// A node around a click with the wall points that rays find, without direction and height; empty
/// if no ray meets a wall.
std::optional<TrackedNode> sacNodeAt(TrackRun& run, const SeedPoint& click);

/// Sets the directions and heights of a chain of at least two nodes to those of the step to the
/// next node; the last node repeats the one before.
void alignWithChain(std::vector<TrackedNode>& nodes);

/// Wall points of an aneurysm from its ordered centres, all of which have a radius. `parent`, which
/// may be null, is joined to the end of the chain that is nearer to it.
TrackedBranch captureAneurysm(TrackRun& run, const SeedBranch& seed, const TrackedBranch* parent);

}  // namespace lumen::convert
