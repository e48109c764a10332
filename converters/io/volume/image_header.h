// SPDX-License-Identifier: Apache-2.0
// A header of NRRD or MetaImage, all of it that concerns lumen: what the parsers of both make of
// their fields.
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
  std::string encoding;  ///< as the format calls it
  std::vector<std::string> assumptions;
};

/// Throws Error(InvalidInput), naming the file, for what is not a header of NRRD 1 to 5 of a scalar
/// 3-D volume whose every field that counts is sound, and for files of voxels that are missing or
/// not allowed; Error(Unsupported) for an encoding that is not read.
ImageHeader readNrrdHeader(const std::filesystem::path& path, const ReadVolumeOptions& options);

/// The same of MetaImage.
ImageHeader readMetaHeader(const std::filesystem::path& path, const ReadVolumeOptions& options);

/// The first three sizes, those of a volume's axes. Throws Error(InvalidInput) unless there are three,
/// and the product of all sizes is one that a file can hold.
std::array<int, 3> volumeSize(const std::filesystem::path& path,
                              const std::vector<std::int64_t>& sizes);

/// Says which of the voxels of a file with axes of these sizes are those of the volume that the
/// options choose. Throws as chosenVolume() does.
void chooseVoxels(const std::filesystem::path& path, const std::vector<std::int64_t>& sizes,
                  const ReadVolumeOptions& options, StoredVoxels& voxels,
                  std::size_t voxelsOfVolume);

}  // namespace lumen::convert
