// SPDX-License-Identifier: Apache-2.0
// Volume files to and from memory, through ITK.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/common/progress.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A box in index space, both corners included.
struct IndexBox {
  std::array<int, 3> low{}, high{};
};

struct ReadVolumeOptions {
  std::string series;  ///< DICOM series instance UID, or its 1-based number in the listing; "" =
                       ///< the only one
  std::optional<IndexBox> crop;  ///< keep only this box; the origin moves with it
};

/// Reads NIfTI-1, NRRD, MetaImage, or a DICOM series (the files of a directory, not of its
/// subdirectories), 3-D, scalar, of any pixel type. A direction that is orthonormal within 1e-3 is
/// made exactly so. Throws Error(InvalidInput) for a file that is missing, truncated or damaged,
/// not 3-D, multi-component, constant, has voxels that are not finite, axes that are not
/// orthogonal, a spacing that is not positive or a crop box outside of it, for a DICOM stack with
/// gaps, or for an ambiguous DICOM series (the message lists them); Error(Unsupported) for another
/// file type; Error(Cancelled).
Volume readVolume(const std::filesystem::path& path, const ReadVolumeOptions& options,
                  const Progress& progress);

/// True if `path` looks like a volume by its name: .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd, or a
/// directory.
bool isVolumePath(const std::filesystem::path& path);

}  // namespace lumen::convert
