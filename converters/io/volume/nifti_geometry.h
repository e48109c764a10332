// SPDX-License-Identifier: Apache-2.0
// Conversion between NIfTI-1's header, in RAS, and lumen's geometry, in LPS.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/io/volume/image_header.h"
#include "converters/io/volume/nifti_header.h"

namespace lumen::convert {

/// The placement of the voxels by `header`. The sform is used if its axes are orthogonal and either
/// the qform is not stated, or the sform is the scanner's; the qform otherwise. A transform that is
/// invalid (numbers that are not finite, no rotation) is replaced by the other, and if none is
/// stated, the volume's own axes are used; this, transforms that disagree, and another spacing in
/// the sform that the options do not settle, append a sentence each to `assumptions`. Throws
/// Error(InvalidInput), naming `path`, if transforms are stated and none can be used.
StatedGeometry niftiGeometry(const NiftiHeader& header, const ReadVolumeOptions& options,
                             const std::filesystem::path& path,
                             std::vector<std::string>& assumptions);

/// The bytes before the voxels of a file of this volume: qform and sform are both written, as
/// scanner coordinates in mm. Throws Error(Unsupported), naming `path`, for more than 32767 voxels
/// along an axis.
std::string niftiHeader(const Volume& volume, const std::filesystem::path& path);

}  // namespace lumen::convert
