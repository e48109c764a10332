// SPDX-License-Identifier: Apache-2.0
// GDCM as what it is used for: the decoder of JPEG, JPEG-LS and JPEG 2000. It runs in a process of
// its own (isolated_call.h): Debian's is built with assertions, which damaged streams set off, and
// these decoders are where most of the faults of image libraries have been.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/volume/dicom_image.h"

namespace lumen::convert {

/// Pixels of one frame in this machine's byte order, from its fragments joined. Throws
/// Error(InvalidInput), without the file's name, if the stream does not announce what the image
/// does, or is damaged; Error(Cancelled).
std::vector<std::byte> decodeDicomFrame(const DicomImage& image,
                                        const std::vector<std::byte>& stream,
                                        const Progress& progress);

}  // namespace lumen::convert
