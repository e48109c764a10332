// SPDX-License-Identifier: Apache-2.0
// Files of NRRD and MetaImage. The header is read by lumen's own strict parsers, because headers
// are the place of false statements and attacks: libraries repair malformed numbers, allocate
// before they look at the data, and open any file that a header names. Only zlib takes part in
// reading the voxels.
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/volume_header.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// `format` is Nrrd or MetaImage. Both functions throw as readVolume() does.
Volume readImageFile(const std::filesystem::path& path, VolumeFormat format,
                     const ReadVolumeOptions& options, const Progress& progress);
VolumeHeader readImageFileHeader(const std::filesystem::path& path, VolumeFormat format,
                                 const ReadVolumeOptions& options, const Progress& progress);

}  // namespace lumen::convert
