// SPDX-License-Identifier: Apache-2.0
// Reader of volume files.
#pragma once

#include <filesystem>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "converters/io/volume/volume_format.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The header of a volume, with the options applied, in a time that does not depend on the number
/// of its voxels. Throws as readVolume() does for faults that show without a voxel, such as a file
/// that is too short for the voxels that its header announces.
VolumeHeader readVolumeHeader(const InputFile& file, const VolumeFormat& format,
                              const ReadVolumeOptions& options, const Progress& progress);

/// Reads a file of NIfTI-1, NRRD or MetaImage, or a DICOM series (of the files of a folder and
/// of the folders below it), whatever its name; 3-D, scalar, of any pixel type. A direction that is
/// orthonormal within 1e-3 is made exactly orthonormal, and axes that lean by more are resampled to an
/// upright grid (upright_grid.h). Throws Error(InvalidInput) for a file that
/// is missing, truncated or damaged, not 3-D, multi-component, constant, has infinite
/// voxels, axes that lean by more than 45 degrees, a spacing that is not positive or a crop box outside of
/// it, for a DICOM stack with gaps, for an ambiguous DICOM series (the message lists them), or for
/// voxels in a file outside of the header's folder that the options do not allow;
/// Error(Unsupported) for features of these formats that lumen does not read; Error(Cancelled).
Volume readVolume(const InputFile& file, const VolumeFormat& format,
                  const ReadVolumeOptions& options, const Progress& progress);

}  // namespace lumen::convert
