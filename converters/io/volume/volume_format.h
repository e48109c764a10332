// SPDX-License-Identifier: Apache-2.0
// The formats of volumes. Headers are read by lumen's own strict parsers, because they are the place
// of false statements and attacks: libraries repair malformed numbers, allocate before they look at
// the data, and open any file that a header names.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
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
  std::optional<std::array<float, 2>> padding{};  ///< as Volume::padding
  /// The grid of the voxels that are read, if the header's is to be resampled from it; its axes lean.
  std::optional<VolumeGeometry> stored{};
  /// Reads the voxels; appends sentences about them to `assumptions`.
  std::function<Voxels(const Progress&, std::vector<std::string>& assumptions)> readVoxels;
};

/// Texts that a header of NRRD holds beside its own fields.
using VolumeNotes = std::map<std::string, std::string>;

/// The writer of a format; notes are for NRRD alone. Throws as encodeVolume().
using VolumeEncoder = std::string(const Volume&, bool compressed, const std::filesystem::path&,
                                  const VolumeNotes&);
VolumeEncoder encodeAsNrrd, encodeAsNifti, encodeAsMetaImage;

/// All that this room knows of one format.
struct VolumeFormat {
  /// Reads and checks the header. Throws as readVolumeHeader().
  OpenVolume (*open)(const InputFile&, const ReadVolumeOptions&, const Progress&);
  /// As encodeVolume(); null for a format that is not written.
  VolumeEncoder* encode = nullptr;
  bool isFolder = false;  ///< of a folder or a file; others are of a file

  // Each is defined beside its reader. The voxels of NRRD and MetaImage may be in files of their own
  // that the header names.
  static const VolumeFormat Nrrd, MetaImage;
  /// NIfTI-1, plain or compressed whatever its name. Voxels are scaled by the header's slope and
  /// intercept unless these are 1 and 0 (then they are floats); niftiGeometry() places them.
  /// Error(Unsupported) for NIfTI-2 and pairs of files.
  static const VolumeFormat Nifti;
  /// The series of DICOM files in a folder that the options name, or its only one: slices that form
  /// a regular stack, or frames of files that do; or a file: a DICOMDIR, a slice of a series beside it, a
  /// file of several frames, a segmentation, or a structure set.
  static const VolumeFormat Dicom;
};

}  // namespace lumen::convert
