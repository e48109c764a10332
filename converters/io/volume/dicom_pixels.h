// SPDX-License-Identifier: Apache-2.0
// The pixels of a DICOM image.
#pragma once

#include <cstddef>

#include "converters/base/progress.h"
#include "converters/io/volume/dicom_image.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Frame `frame` of `image`, rescaled. Throws Error(InvalidInput), naming the file, for pixels that
/// are damaged; Error(Cancelled).
Voxels readDicomFrame(const DicomImage& image, std::size_t frame, const Progress& progress);

}  // namespace lumen::convert
