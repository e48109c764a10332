// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/volume_header.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The series of DICOM files in the folder `path` that the options name, or its only one: slices
/// that form a regular stack, or one multi-frame file. Throws as readVolume() does.
Volume readDicom(const std::filesystem::path& path, const ReadVolumeOptions& options,
                 const Progress& progress);

/// The header of a DICOM series, read without its pixels.
VolumeHeader readDicomHeader(const std::filesystem::path& path, const ReadVolumeOptions& options,
                             const Progress& progress);

}  // namespace lumen::convert
