// SPDX-License-Identifier: Apache-2.0
// Volumes whose axes are not orthogonal, as those of a scan under a gantry tilt, on an upright grid.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The grid of a file whose axes lean, where `geometry` is replaced by an upright one: columns of the
/// direction are unit vectors, and no more. Empty for axes that are orthogonal, or so near to it that
/// no voxel moves by more than half its size, and for directions that are no axes of an image, which
/// checkGeometry() refuses: lengths other than 1, and a lean of more than 45 degrees.
///
/// The upright grid keeps the two axes that are nearest to a right angle; the third becomes their
/// normal. It holds all voxels' centres, and has the file's distances along each axis.
std::optional<VolumeGeometry> standUpright(VolumeGeometry& geometry);

/// A sentence on the lean of the stored grid, and on the upright one.
std::string uprightSentence(const VolumeGeometry& stored, const VolumeGeometry& upright);

/// Moves the voxels of the stored grid to that of the volume, by cubic interpolation (R. G. Keys, Cubic
/// convolution interpolation for digital image processing, 1981), and labels by their nearest voxel,
/// also floats beside whole numbers and labels around which all is -1 (settleLabels()). Voxels beyond
/// the stored ones become padding, or what is around the labels. A type without a value that is left
/// becomes the next wider one. Throws Error(Cancelled).
void resampleUpright(const VolumeGeometry& stored, Volume& volume, const Progress& progress);

}  // namespace lumen::convert
