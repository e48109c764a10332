// SPDX-License-Identifier: Apache-2.0
// Ends of vessels that a face of the volume, or the border of its image, cuts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// Leads a path to the middle of the section in which a face of the volume cuts its vessel, or the
/// border of its image. A path
/// to the farthest voxel turns off the axis there, by up to a radius, into the section's corner.
/// `voxels`: numbers in `set`; the end at their back is moved. `depths`: mm from each voxel of the
/// set to the wall, where a face is none (measureDepths()). A path that ends at no face, or lies in
/// the section's ball whole, stays as it is.
void endAtFace(const VoxelSet& set, std::span<const float> depths,
               std::vector<std::uint32_t>& voxels);

}  // namespace lumen::convert
