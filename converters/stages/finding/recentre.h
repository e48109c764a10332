// SPDX-License-Identifier: Apache-2.0
// Courses on the ridges beside them (docs/method.md, section 1.13).
#pragma once

#include <vector>

#include "converters/base/zeroed_array.h"
#include "converters/io/seeds/seeds.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Moves the points of a course, but its ends and those of wide vessels, across it to where the
/// ridge beside them is strongest: the depth among voxels, by which a course runs, says little
/// of the middle of a vessel of two voxels beside others. `grid`: the frame of the points.
/// `strength`: of the ridge through each voxel (ridgeStrength()).
void recentre(const VolumeGeometry& grid, const ZeroedArray<float>& strength,
              std::vector<SeedPoint>& points);

}  // namespace lumen::convert
