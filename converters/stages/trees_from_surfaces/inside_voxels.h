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

/// The least width of the vessels, mm: the width that all but a fiftieth of their length exceed.
/// `surface` is that of `tree`. Measured by rays from the wall through the lumen; each represents
/// the length of vessel that its triangle goes round.
double leastWidth(const ClosedMesh& surface, const TriangleTree& tree);

/// A grid for the inside of a surface: four voxels to `width`, but at most three hundred thousand
/// inside and 2048 along an axis.
VolumeGeometry insideGrid(const ClosedMesh& surface, double width);

/// The indices (x fastest, ascending) of the voxels of a grid, with the axes of space, whose
/// centres lie inside. Lines of voxels along an axis are followed through the surface; a voxel is
/// inside where the lines of two axes find a winding number of the surface that is not zero, so
/// that the effect of a single fault of the surface on one of them is left out. Throws
/// Error(Cancelled).
std::vector<std::size_t> insideVoxels(const TriangleMesh& mesh, const VolumeGeometry& grid,
                                      const Progress& progress);

}  // namespace lumen::convert
