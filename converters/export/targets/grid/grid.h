// SPDX-License-Identifier: Apache-2.0
// A case as grids of signed distances, in formats of others.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "converters/export/shared/target.h"

namespace lumen::convert {

// Options of grids of distances.

enum class GridFormat : std::uint8_t { Nrrd, Nifti, Mhd, Vdb, Cdf };

struct GridOptions {
  std::vector<GridFormat> formats = {GridFormat::Nrrd};
  std::optional<double> band{};  ///< mm
  bool half = false;             ///< VDB: distances of 16 bits
  bool perBranch = false;        ///< a grid for each branch instead of one
  bool exact = false;            ///< distances to the nearest point of the wall
};

/// distance.* in each format, negative in the lumen but in .cdf; branch.*, 1 and the index of the
/// branch whose lumen a sample is in, elsewhere 0; branches.json, which number is which branch.
/// With GridOptions::perBranch such files for each branch, as NAME.distance.*: they answer for that
/// branch and its neighbourhood along the tree, whatever touches it; their samples are some of the
/// one grid's. Throws Error(Usage) for too many samples and for options that exclude one another,
/// Error(Unsupported) for a case that a format cannot hold, Error(Cancelled).
ExportResult exportGrid(const ExportInput& input, const GridOptions& options);

TargetRow gridRow();

}  // namespace lumen::convert
