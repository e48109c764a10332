// SPDX-License-Identifier: Apache-2.0
// The vessels of a case as tracking has its own.
#pragma once

#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/tracked_branch.h"

namespace lumen::convert {

/// All branches of a valid case, in its order. What a case does not keep is 0: the strength of walls, and
/// how far points lie along the axis.
struct KnownTracks {
  explicit KnownTracks(const formats::Case& value);

  std::vector<SeedBranch> seeds;  ///< label, kind, parent; one point, at the first node
  std::vector<TrackedBranch> branches;
};

}  // namespace lumen::convert
