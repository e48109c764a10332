// SPDX-License-Identifier: Apache-2.0
// RANSAC-based tracking of vessels (docs/method.md, section 1; Yureidini's thesis, chapter 3), for
// a new case and in a case that has vessels already (docs/method.md, section 11).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "converters/stages/tracking/cylinders/tracked_tree.h"
#include "converters/stages/tracking/track_run.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/voxels/cube_search.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct TrackResult : TrackRemarks {
  formats::Case result;  ///< tree and wall points; the metadata lack the fit only
};

/// Tracks every seed. No node is put where `isNoVessel`. The result does not depend on the number of
/// threads. Throws
/// Error(InvalidInput) for options out of range and for voxels with one edge over 1000 times as
/// long as another, and Error(Cancelled).
TrackResult trackFromSeeds(const Volume& volume, const std::vector<SeedBranch>& seeds,
                           const TrackOptions& options, Progress& progress,
                           const PlaceTest& isNoVessel = {});

/// The courses in the lumen that remains outside of vessels, given as balls along them in the frame
/// of gridGeometry().
using CoursesInRemainingLumen = std::function<std::vector<SeedBranch>(std::span<const WorldBall>)>;

/// Fits vessels along courses: the points of each seed, with radii, lead along the whole vessel, from
/// its parent's axis to its tip. Vessels whose walls the volume does not show are left out, as
/// failures. No node is put where `isNoVessel`. Then vessels are fitted along the courses of
/// `remaining`, if there is one. The result does not depend on the number of threads. Throws as
/// trackFromSeeds() does.
TrackResult trackAlongCourses(const Volume& volume, const std::vector<SeedBranch>& courses,
                              const PlaceTest& isNoVessel, const TrackOptions& options,
                              Progress& progress, const CoursesInRemainingLumen& remaining = {});

struct AddedTracks : TrackRemarks {
  /// The known nodes and branches, under their indices, and the new ones behind them. New nodes
  /// have no models yet. Equal to the known case if nothing was tracked.
  formats::Case result;
  std::uint32_t firstNewNode = 0, firstNewBranch = 0;
  /// Known nodes with new wall points: an aneurysm opens into their vessel.
  std::vector<std::uint32_t> changed;
  /// Names of node arrays that were dropped because new nodes have no values of them.
  std::vector<std::string> droppedArrays;
};

/// Tracks seeds in a volume with a valid case of it, `known`, whose vessels stay as they are: a new
/// track ends where it meets one, a click in one starts nothing, and a new vessel is joined to its
/// parent through the lumen. `parent` of a seed is the label of a branch of the case or of another
/// seed; a seed without one is joined to the vessel that it runs into. An aneurysm is a chain of
/// clicks with radii. No node is put where `isNoVessel`. The "edit" step of the result lists the
/// tracked seeds. The result does not depend on the number of threads. Throws Error(InvalidInput) if a seed has the label of a branch
/// or of another seed, or an unknown parent, and Error(Cancelled).
AddedTracks addTracksFromSeeds(const TrackingVolume& volume, const formats::Case& known,
                               const std::vector<SeedBranch>& seeds, Progress& progress,
                               const PlaceTest& isNoVessel = {});

/// Adds the vessels along courses, as trackAlongCourses() fits them, to a case as
/// addTracksFromSeeds() does: the stretches that the case does not have. New vessels are named
/// vessel-N by numbers that the case does not use. Throws as addTracksFromSeeds() does.
AddedTracks addTracksAlongCourses(const TrackingVolume& volume, const formats::Case& known,
                                  const std::vector<SeedBranch>& courses,
                                  const PlaceTest& isNoVessel, Progress& progress);

}  // namespace lumen::convert
