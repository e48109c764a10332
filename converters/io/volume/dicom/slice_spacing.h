// SPDX-License-Identifier: Apache-2.0
// Distances between the slices of a DICOM series: regular, rounded, or with gaps that are filled.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/io/volume/dicom/dicom_stack.h"

namespace lumen::convert {

struct SliceSpacing {
  double step = 0;  ///< mm along the normal
  /// For each slice of a volume with gaps its place among the slices that are there, such as 2.5
  /// between two; empty: they are its slices.
  std::vector<double> places;
  std::string filled;  ///< a sentence on filled gaps
};

/// The distance between slices that are sorted by position. Positions that are rounded give their mean
/// distance, with a sentence among the assumptions. If the options state that gaps are filled, missing
/// slices are counted, and slices of several distances get the least of them. Throws
/// Error(InvalidInput), naming `path` and slices, for others, for several images at one position, and if
/// more slices would be filled than there are.
SliceSpacing sliceSpacing(const std::vector<DicomFrame>& slices, const ReadVolumeOptions& options,
                          const std::filesystem::path& path, std::vector<std::string>& assumptions);

/// The slices at these places: grey values are interpolated between two slices, unless one of them is
/// padding there; labels are those of the nearer slice. `slice`: voxels of one.
Voxels slicesAt(const std::vector<double>& places, const Voxels& slices, std::size_t slice,
                const std::optional<std::array<float, 2>>& padding);

}  // namespace lumen::convert
