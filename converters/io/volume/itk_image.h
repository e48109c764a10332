// SPDX-License-Identifier: Apache-2.0
// ITK's library module lumen_itk: image files written by ITK, and the place of filters of ITK. Only
// its source includes headers of ITK, which cost half a minute of compile time each.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Texts that a header of NRRD holds beside its own fields.
using VolumeNotes = std::map<std::string, std::string>;

/// Writes header and voxels into one file of NRRD or MetaImage, whose name must end in .nrrd or
/// .mha. Notes are for NRRD alone. False if ITK reports a failure; a full disk may go unnoticed.
bool writeWithItk(const Volume& volume, const std::filesystem::path& file, VolumeFormat format,
                  bool compressed, const VolumeNotes& notes);

/// Sets the number of threads of ITK's own pool.
void limitItkThreads(int threads);

}  // namespace lumen::convert
