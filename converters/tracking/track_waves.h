// SPDX-License-Identifier: Apache-2.0
// All vessels, parents before children, and who keeps what two of them have tracked (docs/method.md,
// section 1.7).
#pragma once

#include <vector>

#include "converters/tracking/node_fit.h"
#include "converters/tracking/seed_tree.h"

namespace lumen::convert {

/// Tracks every seed, all children of a depth at a time, which do not see one another meanwhile: so
/// the result does not depend on threads. A child whose parent has no track starts beside the
/// nearest ancestor that has one, or as a root. Throws Error(Cancelled).
std::vector<TrackedBranch> trackAll(const TrackContext& context,
                                    const std::vector<SeedBranch>& seeds, const SeedTree& tree,
                                    Progress& progress);

}  // namespace lumen::convert
