// SPDX-License-Identifier: Apache-2.0
// Bone and other tissue as bright as vessels, which is no tube (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/vessel_paths.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

// The tissue around a path, which shows whether it is a vessel's (docs/method.md, section 1.13).

/// Tissue that a path runs through. Unknown within the vessel at which it begins.
enum class PathTissue : std::uint8_t { Unknown, Vessel, BesideBone, Bone };

/// Tissue at each voxel of a path through a set of bright voxels. A vessel has background around
/// it, on one side at least; bone goes on at two opposite sides, as a plate does, or at more, as a
/// sponge. Beside bone, the set ends at bone that is known already. `depths`: mm from each voxel of
/// the set to the wall. `bone`: indices of voxels, ascending, that are no longer in the set.
std::vector<PathTissue> tissueAlong(const VoxelSet& set, std::span<const float> depths,
                                    std::span<const std::size_t> bone,
                                    std::span<const std::uint32_t> path);

/// Bright voxels, and the paths through all of them.
struct BrightPaths {
  const VoxelSet& set;
  std::span<const float> depths;  ///< mm from each voxel of the set to the wall
  std::span<const VesselPath> paths;
  std::function<float(std::size_t)> brightness;  ///< of the voxel of an index, more in vessels
};

/// Whether each voxel of the set is bone: it is nearer to where paths run through bone than to
/// where they do not, and this bone is long for its width or touches bone that is known. Bone has
/// edges that look like vessels: a path along known bone that is brighter than vessels is one of
/// these, and so is a path of which most is bone. `bone`: indices of voxels that were found to be
/// bone before and are no longer in the set, ascending. Empty if nothing is bone. Throws
/// Error(Cancelled).
std::vector<bool> boneVoxels(const BrightPaths& bright, std::span<const std::size_t> bone,
                             const Progress& progress);

}  // namespace lumen::convert
