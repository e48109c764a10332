// SPDX-License-Identifier: Apache-2.0
// Inputs of the commands that read a volume: the volume, the seeds, the tracks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/engine/stage_options.h"
#include "converters/io/seeds/place_seeds.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::engine {

/// The facts in the header of the volume in `file`; warns of those that it leaves open.
convert::VolumeHeader loadVolumeHeader(const std::filesystem::path& file, const FileFormat& format,
                                       const VolumeArguments& volume, Progress& progress);

/// The volume in `file`, read as `format` whatever its name; shows a stage of progress. Assumptions
/// of the reader about facts that the file leaves open become warnings.
convert::Volume readVolumeFile(const std::filesystem::path& file, const FileFormat& format,
                               const VolumeArguments& volume, Progress& progress);

/// Reasons to doubt the voxels of a volume, read from `file`, become warnings. Throws
/// Error(InvalidInput) if all are equal.
void warnOfVoxels(const convert::Volume& volume, const std::string& file, Progress& progress);

/// The volume in `file`, read as `format` whatever its name, for tracking; shows a stage of
/// progress. Assumptions of the reader and reasons to doubt the voxels become warnings.
convert::Volume loadVolume(const std::filesystem::path& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress);

/// Finds the vessels of `volume`, which is read from `file`, without seeds, and tracks them. Vessels
/// of which the volume shows no wall are left out, and listed for --verbose. Throws Error(Failed) if
/// none is left.
convert::TrackResult findAndTrack(const convert::Volume& volume, const std::string& file,
                                  const convert::TrackOptions& options, Progress& progress);

/// Finds the vessels of `volume` without seeds, and tracks them; empty if none is found.
/// `candidates`: number of paths that might be vessels.
convert::TrackResult findAndTrackIfAny(const convert::Volume& volume,
                                       const convert::TrackOptions& options,
                                       std::size_t& candidates, Progress& progress);

/// Adds to a case that was tracked in `volume` the vessels that it lacks, as findAndTrack() finds
/// them; what it has stays as it is. Returns the result with its remarks on the new vessels.
convert::AddedTracks findAndAdd(const convert::TrackingVolume& tracking,
                                const convert::Volume& volume, const formats::Case& known,
                                Progress& progress);

/// The seeds of --seeds, read by the options. Throws Error(InvalidInput) for a file that is
/// missing or invalid.
std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track);

/// The seeds within the volume; those that cannot be placed in it become warnings. Throws
/// Error(InvalidInput) if none can. `track.seeds` is where they are from, for messages.
convert::PlacedSeeds placedSeeds(const convert::Volume& volume,
                                 const std::vector<convert::SeedBranch>& seeds,
                                 const TrackArguments& track, Progress& progress);

/// Warns of seeds that started no track or did not get all that they state. Throws Error(Failed) if
/// all failed, or most and there is a reason to doubt them. Moves the failures to place seeds to
/// those of the result.
void reportOnSeeds(const convert::Volume& volume, const std::vector<convert::SeedBranch>& seeds,
                   const TrackArguments& track, convert::PlacedSeeds& placed,
                   convert::TrackResult& result, Progress& progress);

/// Tracks `seeds` alone through the volume, from their clicks on; the case holds them. Seeds that cannot be placed in it or that start no track
/// become warnings, and failures of the result. `track.seeds` is where they are from, for messages.
/// Throws Error(InvalidInput) if none can be placed, and Error(Failed) if nothing was tracked.
convert::TrackResult placeAndTrack(const convert::Volume& volume,
                                   const std::vector<convert::SeedBranch>& seeds,
                                   const TrackArguments& track, Progress& progress);

}  // namespace lumen::engine
