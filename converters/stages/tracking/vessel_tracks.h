// SPDX-License-Identifier: Apache-2.0
// From seeds to joined vessels with corrected walls: what track() and trackFurther() have in common.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/stages/tracking/tracker.h"
#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {

/// Tracks seeds, parents first, and writes their branches, in the same order. The first `known` are
/// tracked already and stay as they are, but for wall points of vessels that new aneurysms open into.
/// Returns by what walls were corrected. Throws Error(Cancelled).
WallShape trackVessels(const TrackingVolume& volume, const std::vector<SeedBranch>& seeds,
                       std::size_t known, std::vector<TrackedBranch>& branches, Progress& progress);

/// What became of the seeds behind the first `known`.
TrackRemarks remarksOn(const std::vector<SeedBranch>& seeds,
                       const std::vector<TrackedBranch>& branches, std::size_t known);

}  // namespace lumen::convert
