// SPDX-License-Identifier: Apache-2.0
// The DICOM series of a folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/volume/dicom_image.h"

namespace lumen::convert {

/// The images of the series `wanted` (its instance UID, or its number in the listing, from 1;
/// empty: the only one) among the files of `folder`, not of its subfolders, in the order of their
/// names. Files that are no DICOM images are left out. Throws Error(InvalidInput) if there is no
/// such series or several (the message lists them); the fault of a file that belongs to the series,
/// or that names no series; Error(Cancelled).
std::vector<DicomImage> findDicomSeries(const std::filesystem::path& folder,
                                        const std::string& wanted, const Progress& progress);

}  // namespace lumen::convert
