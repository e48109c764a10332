// SPDX-License-Identifier: Apache-2.0
// Header of NRRD or MetaImage, the common result of both parsers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

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

/// The header of an NRRD file. Throws Error(InvalidInput), naming the file, unless it is a header
/// of NRRD 1 to 5 of a scalar 3-D volume in which every relevant field is sound, and for files of
/// voxels that are missing or not allowed; Error(Unsupported) for an encoding that is not read.
ImageHeader readNrrdHeader(const std::filesystem::path& path, const ReadVolumeOptions& options);

/// The header of a MetaImage file. Throws Error(InvalidInput), naming the file, unless it describes
/// a scalar 3-D volume and every relevant field is sound, and for files of voxels that are missing
/// or not allowed; Error(Unsupported) for an encoding that is not read.
ImageHeader readMetaHeader(const std::filesystem::path& path, const ReadVolumeOptions& options);

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
