// SPDX-License-Identifier: Apache-2.0
// One vessel, from its clicks to its ends (docs/method.md, sections 1.5 to 1.7).
#pragma once

#include <span>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Tracks one vessel. `parent` may be null; `finished` are the branches that end this one when it
/// runs into them. Any number of threads may track at once. Throws Error(Cancelled).
TrackedBranch trackBranch(const TrackContext& context, const SeedBranch& seed,
                          const TrackedBranch* parent,
                          std::span<const TrackedBranch* const> finished, Random random);

}  // namespace lumen::convert
