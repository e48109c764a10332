// SPDX-License-Identifier: Apache-2.0
// The apparent strength of noise to the tracker; the smoothing that a volume needs because of it
// and because of thick slices; and the spline of the smoothed volume (docs/method.md, section 1.8).
#pragma once

#include <memory>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/cylinders/rays.h"
#include "converters/stages/tracking/cylinders/track_options.h"

namespace lumen::convert {

/// The strength of the wall (voxel units per mm, as Candidates::strength) that rays find where
/// there is no vessel: the lower quartile, over places spread evenly at random over the volume, of
/// the median over the rays from that place. Zero for a background without noise. Depends on
/// `options.seed`. However uneven the voxels are, the bricks of the spline that it needs are
/// bounded: places are fewer where rays are long in the finest voxels. Throws Error(Cancelled).
double noiseFloor(const BsplineVolume& volume, const TrackOptions& options,
                  const Progress& progress);

/// Excess brightness (or darkness, if `options.dark`) of the vessels over their surroundings, voxel
/// units: the median over the clicks (256 of them, if there are more) of the difference between a
/// click and the lower quartile of the samples of rays of sixteen voxels. Zero without clicks
/// inside of the volume.
double contrastAtClicks(const BsplineVolume& volume, const std::vector<SeedBranch>& seeds,
                        const TrackOptions& options, const Progress& progress);

/// Standard deviations, mm, of the Gaussian along each index axis: `smoothing`, and if `evenBlur`
/// the additional blur that makes the finer axes about as blurred as one that is more than 1.5
/// times as coarse. Without it a round vessel is an ellipse in thick slices, which no cylinder
/// fits. At most the limit of BsplineVolume.
Eigen::Vector3d smoothingAlongAxes(const VolumeGeometry& geometry, double smoothing, bool evenBlur);

struct SmoothedVolume {
  std::unique_ptr<BsplineVolume> spline;
  double smoothing = 0;   ///< mm, without the part that makes the blur even
  double noiseFloor = 0;  ///< noise floor of `spline`
};

/// The spline that a volume is tracked in, and its noise floor. It is smoothed as `options` state,
/// or else by the least amount, in steps up to 1.25 voxels, that makes the wall of a vessel of the
/// clicks' contrast six times as strong as noise; not at all if more is needed, since the clicks
/// then lie on nothing that can be distinguished from noise. The seeds are needed for their
/// contrast only. `geometry`: that of the volume, or another frame of it, in which the seeds are.
SmoothedVolume smoothForNoise(const Volume& volume, const VolumeGeometry& geometry,
                              const std::vector<SeedBranch>& seeds, const TrackOptions& options,
                              const Progress& progress);

}  // namespace lumen::convert
