// SPDX-License-Identifier: Apache-2.0
// A volume that is tracked in again and again: what of it every track needs is made once.
#pragma once

#include <optional>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/point_spread.h"
#include "converters/stages/tracking/smoothing.h"
#include "converters/stages/tracking/track_options.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The spline of a volume with the bricks that were made so far, how strong its noise is, and how its
/// walls are displaced. Any number of threads may track in one. The volume must outlive it.
class TrackingVolume {
public:
  /// For a case that was tracked in this volume: smoothed as its last "track" step says, with that
  /// step's options. Throws as track() does, and Error(InvalidInput) if the case has no such step.
  TrackingVolume(const Volume& volume, const formats::Case& tracked, Progress& progress);
  /// For a volume without a case: smoothed as the noise around these clicks asks for.
  TrackingVolume(const Volume& volume, const std::vector<SeedBranch>& clicks,
                 const TrackOptions& options, Progress& progress);

  [[nodiscard]] const BsplineVolume& spline() const { return *m_smoothed.spline; }
  [[nodiscard]] const VolumeGeometry& geometry() const { return spline().geometry(); }
  [[nodiscard]] double noiseFloor() const { return m_smoothed.noiseFloor; }
  /// The smoothing is the one in use.
  [[nodiscard]] const TrackOptions& options() const { return m_options; }
  /// By what walls are corrected, if the options or a case's vessels have told.
  [[nodiscard]] const std::optional<WallShape>& wallShape() const { return m_wallShape; }

private:
  TrackOptions m_options;
  SmoothedVolume m_smoothed;
  std::optional<WallShape> m_wallShape;
};

/// By what the walls of vessels are corrected, as they show it; with too few of them that show it, the blur
/// is at least that of the voxel's own box and of the smoothing. `branches`: in the order of `seeds`.
WallShape wallShapeOf(const TrackingVolume& volume, const std::vector<SeedBranch>& seeds,
                      const std::vector<TrackedBranch>& branches);

/// The options of a case's last "track" step, smoothing and blur as they were used; defaults for what it
/// does not say. Empty if there is no such step.
std::optional<TrackOptions> recordedTrackOptions(const formats::Case& value);

}  // namespace lumen::convert
