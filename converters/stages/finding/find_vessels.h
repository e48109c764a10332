// SPDX-License-Identifier: Apache-2.0
// The vessels of a whole volume, found without a click (docs/method.md, section 1.13).
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The courses of all vessels that a volume shows: one seed for each, parents first, whose points
/// with their radii lie along it, from its parent's axis to its tip. Vessels that hang together are
/// one tree, from the tip of its widest vessel. An aneurysm's points are inside of it. Radii are as
/// coarse as the voxels; the tracker measures them. `dark`: vessels are darker than their
/// background. Throws Error(Cancelled).
std::vector<SeedBranch> findVessels(const Volume& volume, bool dark, Progress& progress);

}  // namespace lumen::convert
