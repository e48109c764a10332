// SPDX-License-Identifier: Apache-2.0
// Volume files into memory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/common/progress.h"
#include "converters/volume/volume.h"

namespace lumen::convert {

/// How a volume is stored. Of NRRD and MetaImage, the voxels may be in a file of their own that the
/// header names.
enum class VolumeFormat { Nrrd, Nifti, MetaImage, Dicom };

/// A box in index space, both corners included.
struct IndexBox {
  std::array<int, 3> low{}, high{};
};

struct ReadVolumeOptions {
  /// DICOM: instance UID of a series, or its number in the listing, from 1; empty: the only one.
  std::string series;
  std::optional<IndexBox> crop;  ///< keep only this box; the origin moves with it
};

/// Reads a file of NIfTI-1, NRRD or MetaImage, or a DICOM series (the files of a folder, not of its
/// subfolders), whatever its name; 3-D, scalar, of any pixel type. A direction that is orthonormal
/// within 1e-3 is made exactly so. Throws Error(InvalidInput) for a file that is missing, truncated
/// or damaged, not 3-D, multi-component, constant, has voxels that are not finite, axes that are
/// not orthogonal, a spacing that is not positive or a crop box outside of it, for a DICOM stack
/// with gaps, or for an ambiguous DICOM series (the message lists them); Error(Unsupported) for
/// what these formats allow and lumen does not read; Error(Cancelled).
Volume readVolume(const std::filesystem::path& path, VolumeFormat format,
                  const ReadVolumeOptions& options, const Progress& progress);

}  // namespace lumen::convert
