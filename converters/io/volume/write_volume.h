// SPDX-License-Identifier: Apache-2.0
// The writer of volumes, as bytes of a file, and their record in a case.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/io/volume/volume_format.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Voxels of any type as a header of NRRD describes them.
struct NrrdVoxels {
  std::string_view type;  ///< NRRD's name: "short"
  VolumeGeometry geometry{};
  std::string_view space = "left-posterior-superior";
  std::string_view unit{};  ///< of lengths; empty: not stated
};

/// The header of a file of NRRD, up to the voxels, which follow little-endian in
/// `encoding`: "raw" or "gzip".
std::string nrrdHeader(const NrrdVoxels& voxels, std::string_view encoding,
                       const VolumeNotes& notes = {});

/// The bytes of a file of NRRD with these voxels, little-endian.
std::string encodeNrrd(const NrrdVoxels& voxels, std::string_view bytes, bool compressed,
                       const VolumeNotes& notes = {});

/// The bytes of one file with header and voxels; equal volumes give equal bytes. `file` is named in
/// messages; notes are for NRRD alone. Throws Error(Unsupported) for a format that is not written, and for more than 32767
/// voxels along an axis of NIfTI.
std::string encodeVolume(const Volume& volume, const VolumeFormat& format, bool compressed,
                         const std::filesystem::path& file, const VolumeNotes& notes = {});

/// The header of a MetaImage file whose voxels are in the file `raw` beside it, as voxelBytes().
std::string metaImageHeader(const Volume& volume, const std::string& raw);

/// The voxels, x fastest, little-endian.
std::string_view voxelBytes(const Volume& volume);

/// The record of a volume without the digest of its voxels.
formats::SourceVolume describeGeometry(const VolumeGeometry& geometry);

/// The record of `volume` that a case keeps. The digest is SHA-256 over voxelBytes().
formats::SourceVolume describeSource(const Volume& volume);

}  // namespace lumen::convert
