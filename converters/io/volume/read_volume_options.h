// SPDX-License-Identifier: Apache-2.0
// Options for reading a volume, and the user's statements that override its header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "converters/base/field_word.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

struct ReadVolumeOptions {
  /// DICOM: instance UID of a series, or its number in the listing, from 1; empty: the only one.
  std::string series{};
  std::optional<CellBox> crop{};  ///< keep only this box; the origin moves with it
  /// Index of the volume in a file that holds several, from 0, as 4-D files of NIfTI, NRRD and
  /// MetaImage do.
  std::optional<int> volumeIndex{};
  /// Mm along i, j, k; overrides the header.
  std::optional<Eigen::Vector3d> spacing{};
  /// Mm of the unit of the header's lengths; overrides the header's own statement.
  std::optional<double> unit{};
  /// Files, and folders with everything below them, that may hold voxels besides
  /// the header's own folder.
  std::vector<std::filesystem::path> allowedDetached{};
  /// DICOM: files that cannot be read are left out, and an assumption names each, instead of a
  /// refusal of the series.
  bool skipFaulty = false;
  bool fillGaps = false;  ///< DICOM: slices that are missing are interpolated between others
  /// The grid on which contours are filled (RTSTRUCT); empty: that of the images which they refer to.
  std::optional<VolumeGeometry> grid{};
  bool allowsConstant = false;  ///< voxels may all be equal, as those of a mask of nothing are
  /// Names, in messages and assumptions, the fields by which a caller states these: "series",
  /// "volume-index", "spacing", "unit", "allow-detached", "fill-gaps".
  FieldWord word{};
};

// Properties of a volume that are known before its voxels are read.

struct VolumeHeader {
  VolumeGeometry geometry;
  std::string storedType;         ///< voxel type: int8, uint8, ... uint64, float32 or float64
  std::string encoding;           ///< encoding in the format's words: "raw", "gzip"
  std::uint64_t voxelBytes = 0;   ///< size of all voxels in the stored type, unpacked
  std::uint64_t storedBytes = 0;  ///< size of the files that hold them
  std::string placedBy;   ///< of a NIfTI's transforms the one that counts; empty for other formats
  std::string resampled;  ///< a sentence; empty where the voxels are those of the file
  /// Assumptions of the reader where the header is incomplete: each a sentence that names the
  /// assumption and the option that overrides it. They do not name the file.
  std::vector<std::string> assumptions;
};

}  // namespace lumen::convert
