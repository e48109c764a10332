// SPDX-License-Identifier: Apache-2.0
// What is known of a volume before one of its voxels is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/voxels/volume.h"

namespace lumen::convert {

struct VolumeHeader {
  VolumeGeometry geometry;
  std::string storedType;  ///< of a voxel in the file: int8, uint8, ... uint64, float32 or float64
  std::string encoding;    ///< of the voxels in the file, as its format calls it: "raw", "gzip"
  std::uint64_t voxelBytes = 0;   ///< of all voxels in the stored type, unpacked
  std::uint64_t storedBytes = 0;  ///< of the files that hold them
  /// What the header leaves open and its reader assumed: each a sentence that names the assumption
  /// and the option that states it otherwise. They do not name the file.
  std::vector<std::string> assumptions;
};

}  // namespace lumen::convert
