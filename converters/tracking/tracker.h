// SPDX-License-Identifier: Apache-2.0
// RANSAC-based tracking of vessels (docs/method.md, section 1; Yureidini's thesis, chapter 3).
#pragma once

#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "converters/seeds/seeds.h"
#include "converters/tracking/track_options.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct TrackResult {
  formats::Case result;  ///< tree and wall points; metadata complete but for the fit
  std::vector<SeedFailure> failures;
  std::vector<SeedFailure> missedPoints;  ///< of vessels that were tracked
};

/// Tracks every seed. The result does not depend on the number of threads. Throws
/// Error(InvalidInput) for options out of range and for voxels with one edge over 1000 times as long
/// as another, and Error(Cancelled).
TrackResult track(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress);

}  // namespace lumen::convert
