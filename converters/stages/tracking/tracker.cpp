// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/tracker.h"

#include "converters/io/volume/write_volume.h"
#include "converters/stages/tracking/case_of_tracks.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/stages/tracking/vessel_tracks.h"

namespace lumen::convert {

TrackResult track(const Volume& volume, const std::vector<SeedBranch>& seeds,
                  const TrackOptions& options, Progress& progress) {
  const TrackingVolume tracking(volume, seeds, options, progress);
  std::vector<TrackedBranch> branches;
  TrackOptions used = tracking.options();
  used.pointSpread = trackVessels(tracking, seeds, 0, branches, progress).pointSpread;

  TrackResult out{remarksOn(seeds, branches, 0), caseOfTracks(seeds, branches)};
  out.result.metadata.voxelSize = volume.geometry.voxelSize();
  out.result.metadata.source = describeSource(volume);
  out.result.metadata.steps.push_back({"track", "lumen " LUMEN_VERSION, used.parameters()});
  return out;
}

}  // namespace lumen::convert
