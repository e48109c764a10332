// SPDX-License-Identifier: Apache-2.0
// Inputs of the commands that read a volume: the volume and the seeds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/engine/stage_options.h"
#include "converters/io/seeds/seeds.h"
#include "converters/operations/source.h"
#include "converters/voxels/volume.h"

namespace lumen::engine {

/// The facts in the header of the volume in `file`; warns of those that it leaves open.
convert::VolumeHeader loadVolumeHeader(const InputFile& file, const FileFormat& format,
                                       const VolumeArguments& volume, Progress& progress);

/// The volume in `file`, read as `format` whatever its name; shows a stage of progress. Assumptions
/// of the reader about facts that the file leaves open become warnings.
convert::Volume readVolumeFile(const InputFile& file, const FileFormat& format,
                               const VolumeArguments& volume, Progress& progress);

/// Reasons to doubt the voxels of a volume, read from `file`, become warnings. Throws
/// Error(InvalidInput) if all are equal.
void warnOfVoxels(const convert::Volume& volume, const std::string& file, Progress& progress);

/// The volume in `file`, read as `format` whatever its name, for tracking; shows a stage of
/// progress. Assumptions of the reader and reasons to doubt the voxels become warnings.
convert::Volume loadVolume(const InputFile& file, const FileFormat& format,
                           const VolumeArguments& volume, Progress& progress);

/// The scan of --native; empty if no file is given. Throws Error(InvalidInput) for a file that is
/// missing or no volume.
std::optional<operations::NativePart> loadNative(const InputFile& file, Progress& progress);

/// The seeds of --seeds, read by the options. Throws Error(InvalidInput) for a file that is
/// missing or invalid.
std::vector<convert::SeedBranch> loadSeeds(const TrackArguments& track);

}  // namespace lumen::engine
