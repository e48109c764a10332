// SPDX-License-Identifier: Apache-2.0
// Between NIfTI-1's header, in RAS, and lumen's geometry, in LPS.
#pragma once

#include <filesystem>

#include <nifti/nifti1.h>

#include "converters/volume/volume.h"

namespace lumen::convert {

/// The geometry of a header in this machine's byte order with at least three sizes and spacings
/// that are positive; unchecked otherwise. Throws Error(InvalidInput), naming `path`, if it states
/// a transform, but none of orthogonal axes.
VolumeGeometry niftiGeometry(const nifti_1_header& header, const std::filesystem::path& path);

/// A header for one file of voxels of NIfTI `datatype`. Throws Error(Unsupported), naming `path`,
/// for more than 32767 voxels along an axis.
nifti_1_header niftiHeader(const VolumeGeometry& geometry, short datatype,
                           const std::filesystem::path& path);

}  // namespace lumen::convert
