// SPDX-License-Identifier: Apache-2.0
// A volume in which vessels are tracked repeatedly, with the data that every track needs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/corrections.h"
#include "converters/stages/tracking/cylinders/smoothing.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

// The frame in which vessels are tracked, so that a volume's place in space decides nothing.

/// The frame of gridGeometry().
class GridFrame {
public:
  explicit GridFrame(const VolumeGeometry& world);

  [[nodiscard]] const VolumeGeometry& geometry() const { return m_grid; }
  /// Seeds in this frame, at places a thousandth of a voxel apart.
  [[nodiscard]] std::vector<SeedBranch> toGrid(std::vector<SeedBranch> seeds) const;
  [[nodiscard]] Eigen::Vector3d toWorld(const Eigen::Vector3d& point) const;  ///< mm, LPS
  void toWorld(TrackedBranch& branch) const;

private:
  VolumeGeometry m_world, m_grid;
};

/// The spline of a volume with the bricks that were made so far, the strength of its noise, and the
/// displacement of its walls. Any number of threads may track in one. The volume must outlive it.
class TrackingVolume {
public:
  /// Prepares the volume for a case that was tracked in it: smoothed as its last "track" step
  /// states, with that step's options. Throws as trackFromSeeds() does, and Error(InvalidInput) if
  /// the case has no such step. `word` names fields of the options in messages.
  TrackingVolume(const Volume& volume, const formats::Case& tracked, Progress& progress,
                 const FieldWord& word = {});
  /// Prepares a volume without a case: smoothed as the noise around these clicks requires.
  TrackingVolume(const Volume& volume, const std::vector<SeedBranch>& clicks,
                 const TrackOptions& options, Progress& progress);
  /// Prepares a volume without a case in the frame of its grid, from which results are to be turned
  /// back.
  TrackingVolume(const Volume& volume, const GridFrame& frame,
                 const std::vector<SeedBranch>& clicks, const TrackOptions& options,
                 Progress& progress);

  [[nodiscard]] const BsplineVolume& spline() const { return *m_smoothed.spline; }
  [[nodiscard]] const VolumeGeometry& geometry() const { return spline().geometry(); }
  [[nodiscard]] double noiseFloor() const { return m_smoothed.noiseFloor; }
  /// The smoothing is the one in use.
  [[nodiscard]] const TrackOptions& options() const { return m_options; }
  /// The shape by which walls are corrected, if the options or a case's vessels have given it.
  [[nodiscard]] const std::optional<WallShape>& wallShape() const { return m_wallShape; }

private:
  /// The volume, or what continues its image.
  const Volume& imageOf(const Volume& volume, Progress& progress);
  void prepare(const Volume& volume, const VolumeGeometry& geometry,
               const std::vector<SeedBranch>& clicks, const Progress& progress);

  TrackOptions m_options;
  std::shared_ptr<const Volume> m_continued;  ///< null if all of the volume is image
  SmoothedVolume m_smoothed;
  std::optional<WallShape> m_wallShape;
};

/// The shape by which the walls of vessels are corrected, measured on the branches of a tree; where
/// too few of them show it, the blur is at least that of the voxel's own box and of the smoothing.
WallShape measureWallShape(const TrackingVolume& volume, const TrackedTree& tree);

/// A doubt about a volume in which vessels are to be tracked, as a sentence without the file's
/// name: its voxels have two values only, as a mask has. Throws Error(InvalidInput), with such a
/// sentence, if all are equal.
std::optional<std::string> doubtAbout(const Volume& volume);

/// The options of a case's last "track" step, with smoothing and blur as they were used; defaults
/// for those that it lacks. Empty if there is no such step.
std::optional<TrackOptions> recordedTrackOptions(const formats::Case& vesselCase);

}  // namespace lumen::convert
