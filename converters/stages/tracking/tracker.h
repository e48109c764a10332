// SPDX-License-Identifier: Apache-2.0
// RANSAC-based tracking of vessels (docs/method.md, section 1; Yureidini's thesis, chapter 3).
#pragma once

#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_options.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// An end of a tracked vessel, and why it is there.
struct TrackEnd {
  std::string label;
  bool isStart = false;  ///< of a root that was tracked both ways, the other end
  formats::StopReason reason = formats::StopReason::Unknown;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  /// mm for which the lumen is seen to lead on from there, at least; 0 if it ends
  double goesOn = 0;
};

/// What became of the seeds.
struct TrackRemarks {
  std::vector<SeedFailure> failures;
  std::vector<SeedFailure> missedPoints;  ///< of vessels that were tracked
  std::vector<SeedFailure> unjoined;      ///< vessels that were tracked, and hang on no parent
  std::vector<TrackEnd> ends;             ///< of the vessels that were tracked, in the seeds' order
};

struct TrackResult : TrackRemarks {
  formats::Case result;  ///< tree and wall points; metadata complete but for the fit
};

/// Tracks every seed. The result does not depend on the number of threads. Throws
/// Error(InvalidInput) for options out of range and for voxels with one edge over 1000 times as long
/// as another, and Error(Cancelled).
TrackResult track(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress);

}  // namespace lumen::convert
