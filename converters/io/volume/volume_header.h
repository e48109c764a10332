// SPDX-License-Identifier: Apache-2.0
// Properties of a volume that are known before its voxels are read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/voxels/volume.h"

namespace lumen::convert {

struct VolumeHeader {
  VolumeGeometry geometry;
  std::string storedType;         ///< voxel type: int8, uint8, ... uint64, float32 or float64
  std::string encoding;           ///< encoding in the format's words: "raw", "gzip"
  std::uint64_t voxelBytes = 0;   ///< size of all voxels in the stored type, unpacked
  std::uint64_t storedBytes = 0;  ///< size of the files that hold them
  std::string placedBy;  ///< of a NIfTI's transforms the one that counts; empty for other formats
  /// Assumptions of the reader where the header is incomplete: each a sentence that names the
  /// assumption and the option that overrides it. They do not name the file.
  std::vector<std::string> assumptions;
};

}  // namespace lumen::convert
