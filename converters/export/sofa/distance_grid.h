// SPDX-License-Identifier: Apache-2.0
// The wall of a case as distances on a grid, for SOFA without a plugin of lumen's.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "converters/common/progress.h"

namespace lumen::convert {

/// Samples of the signed distance to the wall, positive in the lumen, as libblob's queries have it.
struct DistanceGrid {
  std::array<int, 3> size{};
  std::array<double, 3> first{};  ///< mm, LPS, of the first sample
  double spacing = 0;             ///< mm, along x, y and z
  std::vector<double> distance;   ///< mm, x fastest
  [[nodiscard]] std::array<double, 3> last() const;
};

/// More samples than this are refused: 256 MB of doubles.
inline constexpr std::size_t kMostGridSamples = std::size_t{1} << 25;

/// A grid over the box from `low` to `high`, mm, and a margin of 1 mm and three spacings, which is what contacts look
/// for at its border. `spacing` 0: a quarter of `thinnest`, mm, but at most eight million samples. `file`: the bytes
/// of the case. Throws Error(Usage) for a spacing that makes too many samples, Error(Cancelled).
DistanceGrid distanceGrid(std::span<const std::byte> file, const std::array<double, 3>& low,
                          const std::array<double, 3>& high, double spacing, double thinnest,
                          Progress& progress);

/// Little-endian doubles, for RigidDistanceGridCollisionModel.
std::string encodeGridDoubles(const DistanceGrid& grid);

/// Little-endian floats, for DiscreteGridField, which takes them from the file beside the header whose name ends
/// in .raw, whatever the header says.
std::string encodeGridFloats(const DistanceGrid& grid);

/// The MetaImage header of those; `raw` is their file's name.
std::string gridHeader(const DistanceGrid& grid, const std::string& raw);

}  // namespace lumen::convert
