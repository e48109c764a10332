// SPDX-License-Identifier: Apache-2.0
// The inside of a closed surface as voxels.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The least width of the vessels, mm: that which all but a fiftieth of their length exceed.
/// `surface` is that of `tree`. Measured by rays from the wall through the lumen, of which each
/// stands for the length of vessel that its triangle goes round.
double leastWidth(const ClosedMesh& surface, const TriangleTree& tree);

/// A grid for the inside of a surface: four voxels to `width`, but no more than three hundred thousand inside
/// and 2048 along an axis.
VolumeGeometry insideGrid(const ClosedMesh& surface, double width);

/// The indices (x fastest, ascending) of the voxels of a grid whose axes are those of space and whose
/// centres lie inside. Lines of voxels along an axis are followed through the surface; a voxel is
/// inside where lines of two axes say that the surface goes round it a number of times that is not
/// zero: what single faults of a surface do to one of them is left out. Throws Error(Cancelled).
std::vector<std::size_t> insideVoxels(const TriangleMesh& mesh, const VolumeGeometry& grid,
                                      const Progress& progress);

}  // namespace lumen::convert
