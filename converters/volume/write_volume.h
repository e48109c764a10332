// SPDX-License-Identifier: Apache-2.0
// Volumes from memory into files and into the record that a case keeps of its volume.
#pragma once

#include <filesystem>

#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Writes .nii, .nii.gz, .nrrd or .mha, atomically; compressed where the format allows it.
void writeVolume(const Volume& volume, const std::filesystem::path& path);

/// The record of `volume` that a case keeps. The digest is SHA-256 over the voxels, x fastest, in
/// the in-memory pixel type, little-endian.
formats::SourceVolume describeSource(const Volume& volume);

}  // namespace lumen::convert
