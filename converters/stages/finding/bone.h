// SPDX-License-Identifier: Apache-2.0
// Bone and other tissue as bright as vessels, which is no tube (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/vessel_paths.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

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
