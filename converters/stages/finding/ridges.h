// SPDX-License-Identifier: Apache-2.0
// Tubular voxels by the second derivatives of a volume (Y. Sato et al., "Three-dimensional
// multi-scale line filter", 1998; A. Frangi et al., "Multiscale vessel enhancement filtering",
// 1998).
#pragma once

#include "converters/base/progress.h"
#include "converters/base/zeroed_array.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Strength of the brightest ridge through each voxel over several scales: the lesser of the two
/// curvatures across it, times the variance of the Gaussian by which the volume was smoothed, in
/// voxel units; 0 where both ways across are not curved downward alike, or the way along is curved
/// as well. Vessels up to about three voxels of radius answer.
///
/// `sign`: 1, or -1 if vessels are darker than their background. Works on bricks, so that its
/// buffers do not grow with the volume. Throws Error(Cancelled).
ZeroedArray<float> ridgeStrength(const Volume& volume, float sign, const Progress& progress);

}  // namespace lumen::convert
