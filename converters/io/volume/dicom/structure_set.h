// SPDX-License-Identifier: Apache-2.0
// Structure sets of radiotherapy (RTSTRUCT; DICOM PS3.3, C.8.8.5 and C.8.8.6) as label maps.
#pragma once

#include "converters/base/progress.h"
#include "converters/io/volume/volume_format.h"

namespace lumen::convert {

/// The closed contours of all structures, filled by the even-odd rule on a grid: that of the options, or
/// of the series that the file refers to, if it lies in the same folder, or else one of its own, as fine
/// as the contours' points. A contour counts for the slices that are nearer to it than to the next
/// one. Points and open contours are left out, and an assumption counts them. Throws
/// Error(InvalidInput), naming `file`, for contours that lie in no plane or in planes that are not
/// parallel, and if there are none.
OpenVolume openStructures(const InputFile& file, const ReadVolumeOptions& options,
                          const Progress& progress);

}  // namespace lumen::convert
