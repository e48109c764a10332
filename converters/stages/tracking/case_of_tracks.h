// SPDX-License-Identifier: Apache-2.0
// From tracks to a case: its tree, its wall points, and where its nodes are from.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/tracked_branch.h"

namespace lumen::convert {

/// Appends tree and points of the branches that have nodes to a case that has points, in the seeds'
/// order but for parents that come after a child. Every parent has nodes. The first `known` branches
/// are those of the case, which may have none. Its arrays of rates and of origins go on; new nodes
/// have no models.
void appendTracks(const std::vector<SeedBranch>& seeds, const std::vector<TrackedBranch>& branches,
                  std::size_t known, formats::Case& target);

/// A case of these branches alone.
formats::Case caseOfTracks(const std::vector<SeedBranch>& seeds,
                           const std::vector<TrackedBranch>& branches);

}  // namespace lumen::convert
