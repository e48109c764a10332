// SPDX-License-Identifier: Apache-2.0
// Cases, volumes and meshes between files and the stages, in the format that was asked for.
#pragma once

#include <filesystem>
#include <string>

#include "converters/app/command.h"
#include "converters/app/file_format.h"
#include "converters/app/options.h"
#include "formats/case/case.h"
#include "formats/case/case_file.h"

namespace lumen::app {

/// Throws Error(InvalidInput) with the file's name and what is wrong in it.
formats::Case readCase(const std::filesystem::path& file);

/// The case, to be changed and written as another: it states the digest of `file`, and has no chunk
/// of others that a change would make wrong.
formats::Case readParentCase(const std::filesystem::path& file);

/// Reads `file` as `format` (a volume format) whatever its name ends in.
convert::Volume readVolumeAs(const std::filesystem::path& file, const FileFormat& format,
                             const VolumeArguments& volume, Progress& progress);

/// Writes atomically as `format` (a case format). Throws Error(Failed).
void writeCase(const formats::Case& value, const std::filesystem::path& file,
               const FileFormat& format, const formats::EncodeOptions& encoding = {});

/// Polygonises the case's models and writes them atomically as `format` (a mesh format).
void writeCaseMesh(const formats::Case& value, const std::filesystem::path& file,
                   const FileFormat& format, const MeshArguments& mesh, Progress& progress);

/// Tracks `seedsFile` through the volume; failed seeds become warnings. Throws Error(Failed) if
/// nothing was tracked.
convert::TrackResult trackSeeds(const convert::Volume& volume, const TrackArguments& track,
                                Progress& progress);

/// Refuses, before any work, a volume without seeds (Usage) and a seeds file that is missing or
/// invalid.
void requireSeeds(const TrackArguments& track);

}  // namespace lumen::app
