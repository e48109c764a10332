// SPDX-License-Identifier: Apache-2.0
// Distance transforms of voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// Distance, mm, from each cell of a box to the nearest one whose mark is `target`, exact; infinite
/// if there is none. `spacing` is that of the voxels. (P. Felzenszwalb, D. Huttenlocher, "Distance
/// transforms of sampled functions", 2012.) Throws Error(Cancelled).
std::vector<float> distancesTo(const CellBox& box, const Eigen::Vector3d& spacing,
                               std::span<const std::uint8_t> mark, std::uint8_t target,
                               const Progress& progress);

/// Distance, mm, from each voxel of a set to the nearest place that is not bright, half a voxel at
/// least: approximate, as voxels take the nearest background from their neighbours (P.-E.
/// Danielsson, "Euclidean distance mapping", 1980). `isBright(index)` is called for the neighbours
/// of the set's voxels. Places beyond the volume count as bright. Infinite where every voxel is
/// bright. Throws Error(Cancelled).
std::vector<float> measureDepths(const VoxelSet& set,
                                 const std::function<bool(std::size_t)>& isBright,
                                 const Progress& progress);

/// distance(position) of each voxel of a set, mm, in parallel. Throws Error(Cancelled).
std::vector<float> depthsBy(const VoxelSet& set,
                            const std::function<double(const Eigen::Vector3d&)>& distance,
                            const Progress& progress);

}  // namespace lumen::convert
