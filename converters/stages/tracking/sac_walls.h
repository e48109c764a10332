// SPDX-License-Identifier: Apache-2.0
// Walls of aneurysms and of their necks, once all vessels are tracked and joined
// (docs/method.md, section 1.7).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Gives the nodes of every aneurysm the whole wall of its sac, lobes included, up to the vessels
/// that it opens into. Nodes of these vessels that stand in the sac or at its neck get the wall
/// that is nearest to them, and lose points within the lumen, which would be a wall across it. An
/// aneurysm that hangs on another is one sac with it. `branches`: in the order of `seeds`. Where no
/// sac is found, the points stay those that rays saw. Of the first `known` branches, vessels are
/// treated like all others; aneurysms bound the new ones, and stay as they are. Throws
/// Error(Cancelled).
void captureSacs(const TrackContext& context, std::span<const SeedBranch> seeds, std::size_t known,
                 std::vector<TrackedBranch>& branches);

}  // namespace lumen::convert
