// SPDX-License-Identifier: Apache-2.0
// The projection of a volume as a camera sees it.
#pragma once

#include "converters/check/picture.h"
#include "converters/common/progress.h"
#include "converters/picture/camera.h"
#include "converters/volume/volume.h"

namespace lumen::convert {

/// The greatest value along each ray, at steps of half of the least spacing, of the nearest voxel; grey between the median of
/// the picture, which is black, and its highest thousandth. Throws Error(Cancelled).
Picture volumeBehind(const Volume& volume, const Camera& camera, Progress& progress);

}  // namespace lumen::convert
