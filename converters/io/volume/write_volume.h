// SPDX-License-Identifier: Apache-2.0
// Writers of volumes, to files and to a case's record of its volume.
#pragma once

#include <filesystem>
#include <string>

#include "converters/io/volume/itk_image.h"
#include "converters/io/volume/read_volume.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Writes header and voxels into one file, atomically. ITK requires that the name ends in .nrrd for
/// NRRD, and in .mha for MetaImage. Throws Error(Unsupported) for DICOM.
void writeVolume(const Volume& volume, const std::filesystem::path& path, VolumeFormat format,
                 bool compressed);

/// The bytes of the file that writeVolume() writes, through a file in the system's folder for
/// temporary files. Notes are for NRRD alone. Throws as writeVolume().
std::string encodeVolume(const Volume& volume, VolumeFormat format, bool compressed,
                         const VolumeNotes& notes = {});

/// The record of a volume without the digest of its voxels.
formats::SourceVolume describeGeometry(const VolumeGeometry& geometry);

/// The record of `volume` that a case keeps. The digest is SHA-256 over the voxels, x fastest, in
/// the in-memory pixel type, little-endian.
formats::SourceVolume describeSource(const Volume& volume);

}  // namespace lumen::convert
