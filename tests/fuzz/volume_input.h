// SPDX-License-Identifier: Apache-2.0
// A volume file for the targets of the volume readers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "converters/io/volume/read_volume_options.h"

namespace lumen::fuzz {

/// Reads header and voxels of a file `name` with these bytes, in a folder of this process where the
/// same bytes are also in the file "d", for headers that name one. Stops the program if what is
/// accepted is not sound, or what is refused has not been refused as a stage must.
void readVolumeOf(const std::uint8_t* data, std::size_t size, const std::string& name,
                  convert::VolumeFormat format);

/// Reads a folder with a DICOM file of these bytes, or with several, between which the bytes have the
/// word "#next-file#". Stops the program as readVolumeOf() does.
void readSeriesOf(const std::uint8_t* data, std::size_t size);

}  // namespace lumen::fuzz
