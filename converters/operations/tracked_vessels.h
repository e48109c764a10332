// SPDX-License-Identifier: Apache-2.0
// The vessels of grey voxels: those that are found, and those that a person states.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/warning.h"
#include "converters/io/seeds/place_seeds.h"
#include "converters/io/seeds/seeds.h"
#include "converters/operations/context.h"
#include "converters/stages/finding/prior.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::operations {

/// The vessels that are wanted.
struct VesselOptions {
  convert::TrackOptions track;
  std::vector<convert::SeedBranch> seeds = {};  ///< clicks of a person, in their own frame
  std::string seedsName = "the seeds";          ///< for messages
  bool isSeedsOnly = false;  ///< seeds start all tracks; else they are hints on what is found
  std::vector<Eigen::Vector3d> roots = {};  ///< places at ends where blood comes in, mm, LPS
  bool isOnlyConnected = false;             ///< without trees in which no seed and no root lies
  convert::Prior prior{};                   ///< knowledge about the voxels, as label maps state it
  std::vector<formats::Case> stated = {};   ///< the trees of these maps
};

/// Words of the message of findAndTrack() where none is left.
inline constexpr const char* kNoVesselsFound = "no vessels are found in it";

/// Finds the vessels of `volume`, called `name`, without seeds, and tracks them. Vessels of which
/// the volume shows no wall are left out, and are details for the listener. Throws Error(Failed) if
/// none is left.
convert::TrackResult findAndTrack(const convert::Volume& volume, const std::string& name,
                                  const VesselOptions& options, const Context& context);

/// Finds the vessels of `volume` without seeds, and tracks them; empty if none is found.
/// `whyNone`: the reason then, to follow "no vessels are found, as ".
convert::TrackResult findAndTrackIfAny(const convert::Volume& volume, const VesselOptions& options,
                                       std::string& whyNone, const Context& context);

/// Adds to a case that was tracked in `volume` the vessels that it lacks, as findAndTrack() finds
/// them; what it has stays as it is. Of the options, knowledge about the voxels and stated trees
/// count. Returns the result with its remarks on the new vessels.
convert::AddedTracks findAndAdd(const convert::TrackingVolume& tracking,
                                const convert::Volume& volume, const formats::Case& known,
                                const VesselOptions& options, const Context& context);

/// The seeds within the volume; those that cannot be placed in it become warnings. Throws
/// Error(InvalidInput) if none can.
convert::PlacedSeeds placedSeeds(const convert::Volume& volume, const VesselOptions& options,
                                 const Context& context);

/// The places that a prior states to be no vessel; empty if it states none. The test keeps both.
convert::PlaceTest placesOfPrior(const convert::Prior& prior,
                                 const convert::VolumeGeometry& geometry);

/// Tracks seeds that are placed, outside of what the prior states to be no vessel.
convert::TrackResult trackPlaced(const convert::Volume& volume, const convert::PlacedSeeds& placed,
                                 const VesselOptions& options, const Context& context);

/// An outcome for a seed, as " started no track: ", behind its name and before the reason.
struct SeedOutcome {
  WarningCode code;
  std::string words;
};

/// One line for each seed, unless there are too many to read: the seed, the outcome and its reason.
void warnOfSeeds(const std::string& file, const SeedOutcome& outcome,
                 const std::vector<convert::SeedFailure>& failures, const Context& context);

/// Warns of seeds that started no track or did not get all that they state. Throws Error(Failed) if
/// all failed, or most and there is a reason to doubt them. Moves the failures to place seeds to
/// those of the result.
void reportOnSeeds(const convert::Volume& volume, const VesselOptions& options,
                   convert::PlacedSeeds& placed, convert::TrackResult& result,
                   const Context& context);

/// Tracks the seeds alone through the volume, from their clicks on; the case holds them. Seeds that
/// cannot be placed in it or that start no track become warnings, and failures of the result. Throws
/// Error(InvalidInput) if none can be placed, and Error(Failed) if nothing was tracked.
convert::TrackResult placeAndTrack(const convert::Volume& volume, const VesselOptions& options,
                                   const Context& context);

}  // namespace lumen::operations
