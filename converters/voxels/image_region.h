// SPDX-License-Identifier: Apache-2.0
// Voxels of a volume that are image, and not what fills the rest (docs/method.md, section 1.13).
#pragma once

#include <memory>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The volume with its image continued over the voxels that are none, and with VolumeGeometry::image
/// set; null if all are image, or if it is set already. These voxels are no image: those of the
/// padding or of a corner's value that are connected with a face of the volume, unless they are
/// specks, and those that the latter blurs. A corner's value counts only if what it leaves is
/// noisy, thick, and more than vessels may fill. Throws Error(Cancelled).
std::shared_ptr<const Volume> continueImage(const Volume& volume, const Progress& progress);

}  // namespace lumen::convert
