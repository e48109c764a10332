// SPDX-License-Identifier: Apache-2.0
// NIfTI-1 files: one reader for header, geometry and voxels, and a writer. The header is read by
// lumen's own reader (nifti_header.h). niftilib's niftiio provides the formulas of quaternions only
// and does not touch the file: its own readers choose a file by its name's ending and take the
// voxels of v.nii.gz from v.nii where both exist, allocate the announced sizes before they look at
// the file, read the header as voxels where an offset points into it, return zeros for NaN and
// infinities, do not verify a gzip stream's checksum, and cannot be stopped.
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/volume_header.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// A scalar volume, plain or compressed whatever its name. Voxels are scaled by the header's slope
/// and intercept unless these are 1 and 0 (then they are floats); niftiGeometry() places them.
/// Throws Error(InvalidInput) if the file is truncated or damaged, states more voxels than the file
/// can hold, or has no sound header or geometry; Error(Unsupported) for NIfTI-2, pairs of files and
/// other pixel types.
Volume readNifti(const std::filesystem::path& path, const ReadVolumeOptions& options,
                 const Progress& progress);

/// The header of a NIfTI-1 file, read without its voxels.
VolumeHeader readNiftiHeader(const std::filesystem::path& path, const ReadVolumeOptions& options,
                             const Progress& progress);

/// Writes to `file` itself, not atomically, and calls it `name` in errors: qform and sform are both
/// written, as scanner coordinates in mm. Throws Error(Failed), or Error(Unsupported) for more than
/// 32767 voxels along an axis.
void writeNifti(const Volume& volume, const std::filesystem::path& file, bool compressed,
                const std::filesystem::path& name);

}  // namespace lumen::convert
