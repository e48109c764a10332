// SPDX-License-Identifier: Apache-2.0
// From tracks to trees: tracks go on as far as the lumen does, gaps are filled, children led to their
// parents (docs/method.md, section 1.12).
#pragma once

#include <cstddef>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {

/// Leads all vessels on from the ends at which they found nothing, as far as the lumen is not
/// another vessel's. What two of them find is the earlier one's. The first `known` branches stay as
/// they are. Throws Error(Cancelled).
void goOnwardAll(const TrackContext& context, const std::vector<SeedBranch>& seeds,
                 std::size_t known, std::vector<TrackedBranch>& branches);

/// Makes one lumen of each tree: fills the gaps of all vessels, leads children to the axis of their
/// parents, and roots that the lumen ties to another tree to that. The first `known` branches, which
/// are joined already, stay as they are. Throws Error(Cancelled).
void joinAll(const TrackContext& context, const std::vector<SeedBranch>& seeds, std::size_t known,
             std::vector<TrackedBranch>& branches);

}  // namespace lumen::convert
