// SPDX-License-Identifier: Apache-2.0
// Places seeds in their volume: which of them can be tracked, and why the others cannot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

struct PlacedSeeds {
  std::vector<SeedBranch> seeds;     ///< mm, LPS, all points inside; parents first
  std::vector<SeedFailure> leftOut;  ///< branches without a point that is left, and their children
  std::vector<SeedFailure> leftPoints;  ///< points that were left out of `seeds`
  /// A more plausible reading of the coordinates, and the fields for it; empty if there is none.
  std::string advice;
};

/// Seeds as points of a volume. A point up to half a voxel beyond the centres of the outermost
/// voxels is moved into their box. Points farther outside are left out, and those with a radius
/// over half of the volume's longest side, or below a tenth of its finest voxel edge. Other
/// readings of the coordinates (as voxels, in another unit, with x and y flipped) are judged by all
/// points together. Throws Error(InvalidInput), with `file` and the advice, if no seed is left. The advice
/// names the fields "seeds-frame", "seeds-unit" and "unit".
PlacedSeeds placeSeeds(const std::vector<SeedBranch>& seeds, const VolumeGeometry& geometry,
                       const std::filesystem::path& file, const FieldWord& word = {});

/// Seeds of a file under another reading of its coordinates.
struct RereadSeeds {
  std::string words;              ///< such as "as RAS (x and y flipped)"
  std::string options;            ///< fields that select this reading
  std::vector<SeedBranch> seeds;  ///< points mm, LPS, also outside of the volume
};

/// Seeds in all other frames and units.
std::vector<RereadSeeds> otherReadings(const std::vector<SeedBranch>& seeds,
                                       const VolumeGeometry& geometry, const FieldWord& word = {});

}  // namespace lumen::convert
