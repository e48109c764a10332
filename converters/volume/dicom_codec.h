// SPDX-License-Identifier: Apache-2.0
// GDCM as what it is used for: the decoder of JPEG, JPEG-LS and JPEG 2000.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/volume/dicom_image.h"

namespace lumen::convert {

/// Pixels of one frame in this machine's byte order, from its fragments joined. Throws
/// Error(InvalidInput), without the file's name, if the stream does not announce what the image
/// does, or is damaged.
std::vector<std::byte> decodeDicomFrame(const DicomImage& image,
                                        const std::vector<std::byte>& stream);

}  // namespace lumen::convert
