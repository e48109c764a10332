// SPDX-License-Identifier: Apache-2.0
// From tracks to a case: its tree, its wall points, and where its nodes are from.
#pragma once

#include <vector>

#include "converters/seeds/seeds.h"
#include "converters/tracking/tracked_branch.h"

namespace lumen::convert {

/// Tree and points of the branches that have nodes, in the seeds' order but for parents that come
/// after a child. Every parent has nodes.
formats::Case caseOfTracks(const std::vector<SeedBranch>& seeds,
                           const std::vector<TrackedBranch>& branches);

}  // namespace lumen::convert
