// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "converters/common/progress.h"
#include "converters/volume/read_volume_options.h"
#include "converters/volume/volume.h"
#include "converters/volume/volume_header.h"

namespace lumen::convert {

/// The series of DICOM files in the folder `path` that the options name, or its only one: slices
/// that make a regular stack, or one multi-frame file. Throws as readVolume() does.
Volume readDicom(const std::filesystem::path& path, const ReadVolumeOptions& options,
                 const Progress& progress);

/// What readDicom() knows before it reads a voxel.
VolumeHeader readDicomHeader(const std::filesystem::path& path, const ReadVolumeOptions& options,
                             const Progress& progress);

}  // namespace lumen::convert
