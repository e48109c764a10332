// SPDX-License-Identifier: Apache-2.0
// Aneurysms are not tubes: their wall points come from the clicks alone (docs/method.md,
// section 1.7; Yureidini's thesis, 3.7).
#pragma once

#include "converters/seeds/seeds.h"
#include "converters/tracking/node_fit.h"

namespace lumen::convert {

/// Wall points of an aneurysm from its ordered centres, all of which have a radius. `parent`, which
/// may be null, is what the first centre hangs on.
TrackedBranch captureAneurysm(const TrackContext& context, const SeedBranch& seed,
                              const TrackedBranch* parent);

}  // namespace lumen::convert
