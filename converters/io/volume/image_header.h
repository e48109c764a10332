// SPDX-License-Identifier: Apache-2.0
// Header of NRRD, MetaImage or NIfTI, the common result of their parsers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "converters/io/volume/open_volume.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/stated_geometry.h"
#include "converters/io/volume/stored_voxels.h"

namespace lumen::convert {

struct ImageHeader {
  StatedGeometry stated;
  StoredVoxels voxels;   ///< with the files that the header names, resolved and allowed
  std::string encoding;  ///< encoding in the format's own words
  std::vector<std::string> assumptions;
};

/// The volume of this header, once the geometry is settled and the files can hold the voxels.
OpenVolume openImage(ImageHeader image, const ReadVolumeOptions& options,
                     const std::filesystem::path& path);

/// The sizes along a volume's three axes, the first three of `sizes`. Throws Error(InvalidInput)
/// unless there are three, and the product of all sizes fits a file.
std::array<int, 3> volumeSize(const std::filesystem::path& path,
                              const std::vector<std::int64_t>& sizes);

/// Selects the voxels of the volume that the options choose, in a file with axes of these sizes.
/// Throws as chosenVolume() does.
void chooseVoxels(const std::filesystem::path& path, const std::vector<std::int64_t>& sizes,
                  const ReadVolumeOptions& options, StoredVoxels& voxels,
                  std::size_t voxelsOfVolume);

}  // namespace lumen::convert
