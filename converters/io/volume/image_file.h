// SPDX-License-Identifier: Apache-2.0
// Files of NRRD and MetaImage. The header is read by lumen's own strict parsers, because that is
// where a file lies or attacks: libraries repair what is no number, allocate before they look at the
// data, and open what files a header names. What is then left to do for the voxels, zlib does.
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/volume_header.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// `format` is Nrrd or MetaImage. Throw as readVolume() does.
Volume readImageFile(const std::filesystem::path& path, VolumeFormat format,
                     const ReadVolumeOptions& options, const Progress& progress);
VolumeHeader readImageFileHeader(const std::filesystem::path& path, VolumeFormat format,
                                 const ReadVolumeOptions& options, const Progress& progress);

}  // namespace lumen::convert
