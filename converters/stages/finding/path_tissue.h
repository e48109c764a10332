// SPDX-License-Identifier: Apache-2.0
// The tissue around a path, which shows whether it is a vessel's (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// Tissue that a path runs through. Unknown within the vessel at which it begins.
enum class PathTissue : std::uint8_t { Unknown, Vessel, BesideBone, Bone };

/// Tissue at each voxel of a path through a set of bright voxels. A vessel has background around
/// it, on one side at least; bone goes on at two opposite sides, as a plate does, or at more, as a
/// sponge. Beside bone, the set ends at bone that is known already. `depths`: mm from each voxel of
/// the set to the wall. `bone`: indices of voxels, ascending, that are no longer in the set.
std::vector<PathTissue> tissueAlong(const VoxelSet& set, std::span<const float> depths,
                                    std::span<const std::size_t> bone,
                                    std::span<const std::uint32_t> path);

}  // namespace lumen::convert
