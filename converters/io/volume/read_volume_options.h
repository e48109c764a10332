// SPDX-License-Identifier: Apache-2.0
// How a volume is to be read, and what of it the user states instead of its header.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "converters/voxels/cell_box.h"

namespace lumen::convert {

/// How a volume is stored. Of NRRD and MetaImage, the voxels may be in files of their own that the
/// header names.
enum class VolumeFormat { Nrrd, Nifti, MetaImage, Dicom };

struct ReadVolumeOptions {
  /// DICOM: instance UID of a series, or its number in the listing, from 1; empty: the only one.
  std::string series{};
  std::optional<CellBox> crop{};  ///< keep only this box; the origin moves with it
  /// Which volume of a file that holds several, from 0, as 4-D files of NIfTI, NRRD and MetaImage do.
  std::optional<int> volumeIndex{};
  /// --spacing: mm along i, j, k, whatever the header says or leaves out.
  std::optional<Eigen::Vector3d> spacing{};
  /// --unit: mm of the unit that the header's lengths are in, whatever the header says of it.
  std::optional<double> unit{};
  /// --allow-detached: files, and folders with all that is below them, that voxels may come from
  /// besides the header's own folder.
  std::vector<std::filesystem::path> allowedDetached{};
};

}  // namespace lumen::convert
