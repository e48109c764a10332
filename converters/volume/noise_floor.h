// SPDX-License-Identifier: Apache-2.0
// What noise alone looks like to the tracker.
#pragma once

#include "converters/volume/rays.h"
#include "converters/volume/tracker.h"

namespace lumen::convert {

/// The strength of the wall (voxel units per mm, as Candidates::strength) that rays find where
/// there is no vessel: the lower quartile, over places spread evenly at random over the volume, of
/// the median over the rays from that place. Zero for a background without noise. Depends on
/// `options.seed`.
double noiseFloor(const BsplineVolume& volume, const TrackOptions& options);

}  // namespace lumen::convert
