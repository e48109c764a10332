// SPDX-License-Identifier: Apache-2.0
// The voxels of a volume that are lumen as far as brightness and shape show it.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Lumen of a volume, before anything is known of its vessels.
struct BrightVoxels {
  std::vector<std::size_t> indices;  ///< ascending, x fastest
  double contrast = 0;               ///< excess of wide vessels over their background, voxel units
  double noise = 0;                  ///< standard deviation of the background, voxel units
};

/// Voxels of wide vessels, which are brighter than halfway between their background and the wide
/// vessels of the volume; and those of thin ones, which lose brightness to blur, by the strength of
/// the ridge that they are on (docs/method.md, section 1.13). Empty if nothing stands out of the
/// noise. `dark`: vessels are darker than their background. Throws Error(Cancelled).
BrightVoxels findBrightVoxels(const Volume& volume, bool dark, const Progress& progress);

}  // namespace lumen::convert
