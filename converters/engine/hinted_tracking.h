// SPDX-License-Identifier: Apache-2.0
// Vessels of a volume by what it shows and by what the user states: seeds and roots.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/engine/stage_options.h"
#include "converters/io/seeds/seeds.h"
#include "converters/judge/compare/repetition.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::engine {

/// Tracks the vessels of `volume`, read from `file`: those of `seeds`, or all that are found where
/// there are none or `track` wants all vessels. In the last case seeds are hints: they name what is
/// found, divide and join it, and start tracks of their own where no vessel is. The case holds the seeds
/// that lie in the volume (case_seeds.h). Roots and selection of `track` apply. Warnings and errors are those of findAndTrack() and placeAndTrack(); also throws
/// Error(Failed) for a root that lies in no vessel.
convert::TrackResult trackVessels(const convert::Volume& volume, const std::string& file,
                                  const std::vector<convert::SeedBranch>& seeds,
                                  const TrackArguments& track, Progress& progress);

/// Tracks as trackVessels() does as often as `track` asks for repeats, with other random numbers
/// and with clicks that are moved by a tenth of a voxel, and states how much of `judged` these runs
/// find again; its nodes get that as LUMEN_repeat.share. Empty without repeats.
std::optional<convert::Repetition> repeatTracks(const convert::Volume& volume,
                                                const std::string& file,
                                                const std::vector<convert::SeedBranch>& seeds,
                                                const TrackArguments& track, formats::Case& judged,
                                                Progress& progress);

/// Roots and selection of `track` for a case without seeds.
void applyRoots(formats::Case& target, const std::string& file, const TrackArguments& track);

}  // namespace lumen::engine
