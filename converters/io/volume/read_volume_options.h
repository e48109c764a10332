// SPDX-License-Identifier: Apache-2.0
// How a volume is to be read, and what of it the user states instead of its header.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace lumen::convert {

/// How a volume is stored. Of NRRD and MetaImage, the voxels may be in files of their own that the
/// header names.
enum class VolumeFormat { Nrrd, Nifti, MetaImage, Dicom };

/// A box in index space, both corners included.
struct IndexBox {
  std::array<int, 3> low{}, high{};
};

struct ReadVolumeOptions {
  /// DICOM: instance UID of a series, or its number in the listing, from 1; empty: the only one.
  std::string series{};
  std::optional<IndexBox> crop{};  ///< keep only this box; the origin moves with it
  /// --spacing: mm along i, j, k, whatever the header says or leaves out.
  std::optional<Eigen::Vector3d> spacing{};
  /// --unit: mm of the unit that the header's lengths are in, whatever the header says of it.
  std::optional<double> unit{};
  /// --allow-detached: files, and folders with all that is below them, that voxels may come from
  /// besides the header's own folder.
  std::vector<std::filesystem::path> allowedDetached{};
};

}  // namespace lumen::convert
