// SPDX-License-Identifier: Apache-2.0
// What the commands that read a volume have in common: the volume, the seeds, the tracks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/app/file_format.h"
#include "converters/app/options.h"
#include "converters/common/progress.h"
#include "converters/seeds/seeds.h"
#include "converters/tracking/tracker.h"

namespace lumen::app {

/// The volume in `file`, read as `format` whatever the name; shows a stage of progress. What the
/// file leaves open and the reader assumed becomes warnings.
convert::Volume loadVolume(const std::filesystem::path& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress);

/// The seeds of --seeds. Throws Error(Usage) without the option, and Error(InvalidInput) for a file
/// that is missing or invalid.
std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track);

/// Tracks `seeds` through the volume; failed seeds become warnings. `origin` is where the seeds are
/// from, for messages. Throws Error(InvalidInput) for a seed outside of the volume, and
/// Error(Failed) if nothing was tracked.
convert::TrackResult trackSeeds(const convert::Volume& volume,
                                const std::vector<convert::SeedBranch>& seeds,
                                const std::string& origin, const convert::TrackOptions& options,
                                Progress& progress);

}  // namespace lumen::app
