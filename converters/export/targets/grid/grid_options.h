// SPDX-License-Identifier: Apache-2.0
// Options of grids of distances.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace lumen::convert {

enum class GridFormat : std::uint8_t { Nrrd, Nifti, Mhd, Vdb, Cdf };

struct GridOptions {
  std::vector<GridFormat> formats = {GridFormat::Nrrd};
  std::optional<double> band{};  ///< mm
  bool half = false;             ///< VDB: distances of 16 bits
  bool perBranch = false;        ///< a grid for each branch instead of one
  bool exact = false;            ///< distances to the nearest point of the wall
};

}  // namespace lumen::convert
