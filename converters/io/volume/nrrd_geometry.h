// SPDX-License-Identifier: Apache-2.0
// Placement of the axes of an NRRD file in space.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/io/volume/image_header.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/io/volume/text_header.h"

namespace lumen::convert {

/// The geometry of a header with these `sizes`, one for each of its axes; axes of a voxel's
/// components or of time are dropped if they have one entry. An unknown unit appends a sentence to
/// `assumptions`. Throws Error(InvalidInput) unless three axes with consistent fields remain.
StatedGeometry nrrdGeometry(const TextHeader& header, const std::vector<std::int64_t>& sizes,
                            const ReadVolumeOptions& options,
                            std::vector<std::string>& assumptions);

}  // namespace lumen::convert
