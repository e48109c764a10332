// SPDX-License-Identifier: Apache-2.0
// All vessels, parents before children, and who keeps what two of them have tracked (docs/method.md,
// section 1.7).
#pragma once

#include <cstddef>
#include <vector>

#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/seed_tree.h"

namespace lumen::convert {

/// Tracks every seed, all children of a depth at a time, which do not see one another meanwhile: so
/// the result does not depend on threads. A child whose parent has no track starts beside the
/// nearest ancestor that has one, or as a root. `branches`: in the order of the seeds; the first
/// `known` are tracked already and stay as they are, the others are written. Throws
/// Error(Cancelled).
void trackAll(const TrackContext& context, const std::vector<SeedBranch>& seeds,
              const SeedTree& tree, std::size_t known, std::vector<TrackedBranch>& branches,
              Progress& progress);

}  // namespace lumen::convert
