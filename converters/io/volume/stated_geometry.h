// SPDX-License-Identifier: Apache-2.0
// Conversion of a header's lengths to millimetres, with the user's statements: equal for every
// format.
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
  std::optional<double> unit;  ///< mm of the file's unit; empty: the header states none
  std::string unitNote;  ///< the assumption where `unit` is empty; empty: it goes without saying
  std::string placedBy;  ///< of several transforms the one that counts; empty: there is one
};

/// The geometry in mm: spacing and unit are those of the options, else of the header, else 1 mm. An
/// assumed spacing, or an implausible one in an assumed unit, appends a sentence to `assumptions`.
/// Throws Error(InvalidInput), naming `path` and the option that helps, for a spacing that is
/// stated along some axes only, or is not positive, finite and within 1e-6 to 1e4 mm, and as
/// checkGeometry() does.
VolumeGeometry settledGeometry(const StatedGeometry& stated, const ReadVolumeOptions& options,
                               const std::filesystem::path& path,
                               std::vector<std::string>& assumptions);

/// Crops `geometry` to `box`. Throws Error(InvalidInput), naming `path`, unless the box holds at
/// least two voxels along each axis and lies within the volume.
void cropGeometry(VolumeGeometry& geometry, const CellBox& box, const std::filesystem::path& path);

}  // namespace lumen::convert
