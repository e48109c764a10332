// SPDX-License-Identifier: Apache-2.0
// Vessels of grey voxels by what these show and by what a person states: seeds and roots.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "converters/judge/compare/repetition.h"
#include "converters/operations/context.h"
#include "converters/operations/tracked_vessels.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Tracks the vessels of `volume`, called `name`: those of the seeds, or all that are found where
/// there are none or the options want all vessels. In the last case seeds are hints: they name what
/// is found, divide and join it, and start tracks of their own where no vessel is. The case holds
/// the seeds that lie in the volume (case_seeds.h). Roots and selection of the options apply.
/// Warnings and errors are those of findAndTrack() and placeAndTrack(); also throws Error(Failed)
/// for a root that lies in no vessel.
convert::TrackResult trackVessels(const convert::Volume& volume, const std::string& name,
                                  const VesselOptions& options, const Context& context);

/// Leaves out vessels of a case that are not wanted; throws Error(Failed) if none is left.
using CaseSelection = std::function<void(formats::Case&, const Context&)>;

/// Tracks as trackVessels() does `repeats` times, with other random numbers and with clicks that are
/// moved by a tenth of a voxel, and states how much of `judged` these runs find again; its nodes get
/// that as LUMEN_repeat.share. `select` may be empty. Empty without repeats.
std::optional<convert::Repetition> repeatTracks(const convert::Volume& volume,
                                                const std::string& name,
                                                const VesselOptions& options, std::uint64_t repeats,
                                                const CaseSelection& select, formats::Case& judged,
                                                const Context& context);

/// Roots and selection of the options for a case without seeds, whose source is called `name`.
void applyRoots(formats::Case& target, const std::string& name, const VesselOptions& options,
                const Context& context);

}  // namespace lumen::operations
