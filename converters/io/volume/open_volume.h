// SPDX-License-Identifier: Apache-2.0
// The formats of volumes that are read: one function each, which reads and checks a header. Headers
// are read by lumen's own strict parsers, because they are the place of false statements and
// attacks: libraries repair malformed numbers, allocate before they look at the data, and open any
// file that a header names.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/base/progress.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// A volume with an accepted header.
struct OpenVolume {
  VolumeHeader header;
  /// Reads the voxels; appends sentences about them to `assumptions`.
  std::function<Voxels(const Progress&, std::vector<std::string>& assumptions)> readVoxels;
};

/// A file of NRRD, or of MetaImage. All functions here throw as readVolumeHeader() does.
OpenVolume openNrrd(const InputFile& file, const ReadVolumeOptions& options,
                    const Progress& progress);
OpenVolume openMetaImage(const InputFile& file, const ReadVolumeOptions& options,
                         const Progress& progress);

/// A file of NIfTI-1, plain or compressed whatever its name. Voxels are scaled by the header's slope
/// and intercept unless these are 1 and 0 (then they are floats); niftiGeometry() places them.
/// Error(Unsupported) for NIfTI-2 and pairs of files. The library niftiio provides the formulas of
/// quaternions only: its own readers choose a file by its name's ending, allocate the announced
/// sizes before they look at the file, read the header as voxels where an offset points into it,
/// return zeros for NaN, and verify no checksum.
OpenVolume openNifti(const InputFile& file, const ReadVolumeOptions& options,
                     const Progress& progress);

/// The series of DICOM files in the folder `folder` that the options name, or its only one: slices
/// that form a regular stack, or one multi-frame file.
OpenVolume openDicom(const InputFile& folder, const ReadVolumeOptions& options,
                     const Progress& progress);

}  // namespace lumen::convert
