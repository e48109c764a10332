// SPDX-License-Identifier: Apache-2.0
// The pixels of a DICOM image.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/volume/dicom/dicom_image.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

// GDCM as the decoder of JPEG, JPEG-LS and JPEG 2000. It runs in a process of its own
// (isolated_call.h): Debian's build has assertions, which damaged streams trigger, and most faults
// of image libraries have been in these decoders.

/// Pixels of one frame in this machine's byte order, from its fragments joined. Throws
/// Error(InvalidInput), without the file's name, if the stream contradicts the image's header, or
/// is damaged; Error(Cancelled).
std::vector<std::byte> decodeDicomFrame(const DicomImage& image,
                                        const std::vector<std::byte>& stream,
                                        const Progress& progress);

/// Frame `frame` of `image`, rescaled. Throws Error(InvalidInput), naming the file, for pixels that
/// are damaged; Error(Cancelled).
Voxels readDicomFrame(const DicomImage& image, std::size_t frame, const Progress& progress);

}  // namespace lumen::convert
