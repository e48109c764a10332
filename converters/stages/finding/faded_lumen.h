// SPDX-License-Identifier: Apache-2.0
// Wide vessels that fade along their course (docs/method.md, section 1.13).
#pragma once

#include <functional>
#include <vector>

#include "converters/base/progress.h"
#include "converters/base/zeroed_array.h"
#include "converters/voxels/cell_box.h"

namespace lumen::convert {

/// Excess of every voxel of a volume over its background, and what of it is lumen.
struct Excess {
  CellBox cells;
  ZeroedArray<float> value;                   ///< for each voxel; brighter is more
  std::function<float(const Cell&)> leastAt;  ///< the least value there that is no noise
};

/// Adds voxels of wide vessels that are less bright than those of the rest of the volume: from
/// block to block of 16 voxels, those that are connected to lumen and are brighter than half of
/// the lumen's median in their block, or in the brightest block beside it. A rim of vessels that
/// are known is left out. `isLumen`: a flag for each voxel. `contrast`: excess of the wide vessels
/// of the volume. Throws Error(Cancelled).
void growIntoFaded(const Excess& excess, float contrast, std::vector<bool>& isLumen,
                   const Progress& progress);

}  // namespace lumen::convert
