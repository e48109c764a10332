// SPDX-License-Identifier: Apache-2.0
// Between NIfTI-1's header, in RAS, and lumen's geometry, in LPS.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nifti/nifti1.h>

#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/stated_geometry.h"

namespace lumen::convert {

/// What `header` says of the voxels' place. The sform gives it where it is of orthogonal axes and
/// either the qform is not stated, or the sform is the scanner's; the qform otherwise. A transform
/// that is no place in space (numbers that are not finite, no rotation) gives way to the other, and
/// none stated to the volume's own axes; this, transforms that disagree, and another spacing in the
/// sform that the options do not settle, append a sentence each to `assumptions`. Throws
/// Error(InvalidInput), naming `path`, if transforms are stated and none can be used.
StatedGeometry niftiGeometry(const NiftiHeader& header, const ReadVolumeOptions& options,
                             const std::filesystem::path& path,
                             std::vector<std::string>& assumptions);

/// A header for one file of voxels of NIfTI `datatype`. Throws Error(Unsupported), naming `path`,
/// for more than 32767 voxels along an axis.
nifti_1_header niftiHeader(const VolumeGeometry& geometry, short datatype,
                           const std::filesystem::path& path);

}  // namespace lumen::convert
