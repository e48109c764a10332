// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "converters/common/progress.h"
#include "converters/volume/volume.h"

namespace lumen::convert {

/// The series of DICOM files in the folder `path`, or its only one for an empty `series`: slices
/// that make a regular stack, or one multi-frame file. Throws as readVolume() does.
Volume readDicom(const std::filesystem::path& path, const std::string& series,
                 const Progress& progress);

}  // namespace lumen::convert
