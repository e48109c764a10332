// SPDX-License-Identifier: Apache-2.0
// Header checks and voxels of NIfTI-1 files. ITK reads the geometry, but not these: it takes a
// pixdim of 0 as 1 and drops a negative one's sign, it fills a truncated .nii.gz with zeros, and it
// reads the voxels of v.nii.gz from v.nii where both exist.
#pragma once

#include <cstddef>
#include <filesystem>

#include "converters/common/progress.h"
#include "converters/volume/volume.h"

namespace lumen::convert {

/// Throws Error(InvalidInput) for a header that is not NIfTI-1's, that states a spacing which is
/// not positive and finite, or more voxel bytes than the file can hold; Error(Unsupported) for
/// NIfTI-2.
void checkNiftiHeader(const std::filesystem::path& path);

/// `count` scalar voxels, scaled by the header's slope and intercept if it has any other than 1 and
/// 0 (then they are floats). Throws Error(InvalidInput) for a truncated or damaged file,
/// Error(Unsupported) for another pixel type.
Voxels readNiftiVoxels(const std::filesystem::path& path, std::size_t count,
                       const Progress& progress);

}  // namespace lumen::convert
