// SPDX-License-Identifier: Apache-2.0
// What a volume file's own header says, before any reader has repaired it.
#pragma once

#include <filesystem>
#include <string>

#include "converters/common/progress.h"

namespace lumen::convert {

/// The container of a volume, by its name.
enum class VolumeFormat { Unknown, Nifti, Nrrd, Meta };

/// .nii, .nii.gz; .nrrd, .nhdr; .mha, .mhd, in any case.
VolumeFormat volumeFormat(const std::filesystem::path& path);

/// Throws Error(InvalidInput) for an NRRD or MetaImage file whose header is not one, whose header
/// states a spacing that is not positive and finite, or whose data is shorter than the header says
/// or a damaged deflate stream. ITK hides these: it reads such spacings as 1 or moves their sign to
/// the direction, allocates before it looks at the data, and keeps what a damaged stream gives.
void checkTextHeader(const std::filesystem::path& path, VolumeFormat format,
                     const Progress& progress);

/// Throws Error(InvalidInput), naming `path` and `field`, unless `value` is a spacing; `axis`
/// counts from 1.
void checkStatedSpacing(const std::filesystem::path& path, const std::string& field, int axis,
                        double value);

/// Throws Error(InvalidInput) if `needed` bytes of voxels cannot come out of `available` bytes of a
/// file.
void checkRoom(const std::filesystem::path& path, double needed, double available, bool compressed);

}  // namespace lumen::convert
