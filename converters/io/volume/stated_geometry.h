// SPDX-License-Identifier: Apache-2.0
// From what a header says of its lengths to millimetres, with what the user states: the same way
// for every format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Geometry as a header states it.
struct StatedGeometry {
  /// Lengths are in the file's unit. A spacing is NaN along an axis whose spacing is not stated.
  VolumeGeometry geometry;
  std::optional<double> unit;  ///< mm of the file's unit; empty: the header does not say
};

/// The geometry in mm: spacing and unit are those of the options, else of the header, else 1 mm. A
/// spacing that is assumed, or that is odd while the unit is, appends a sentence to `assumptions`.
/// Throws Error(InvalidInput), naming `path` and the option that helps, for a spacing that is stated
/// along some axes only, or is not positive, finite and within 1e-6 to 1e4 mm, and whatever
/// checkGeometry() refuses.
VolumeGeometry settledGeometry(const StatedGeometry& stated, const ReadVolumeOptions& options,
                               const std::filesystem::path& path,
                               std::vector<std::string>& assumptions);

/// Makes `geometry` that of `box`. Throws Error(InvalidInput), naming `path`, unless the box holds at
/// least two voxels along each axis and lies within the volume.
void cropGeometry(VolumeGeometry& geometry, const CellBox& box, const std::filesystem::path& path);

}  // namespace lumen::convert
