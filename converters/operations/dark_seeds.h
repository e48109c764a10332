// SPDX-License-Identifier: Apache-2.0
// Seeds where the volume shows nothing, and the vessels nearest to those that name none.
#pragma once

#include <string>
#include <vector>

#include "converters/io/seeds/seeds.h"
#include "converters/operations/context.h"
#include "converters/operations/tracked_vessels.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Seeds that are placed, by whether the volume shows anything at them.
struct LitSeeds {
  /// Those at which it does. The parent of one whose own is dark is that seed's parent.
  std::vector<convert::SeedBranch> lit;
  std::vector<convert::SeedFailure> dark;  ///< the others, with intensities as the reason
};

/// Leaves out seeds all of whose points are in the background (finding/click_level.h): a track that
/// starts there follows noise, or the rim of a background that was cut off.
LitSeeds withoutDark(const convert::Volume& volume, std::vector<convert::SeedBranch> seeds,
                     bool areVesselsDark, const Context& context);

/// Adds to the reason of each failure the distance from the seed's first point to the nearest vessel
/// of a tree, if that has any.
void addNearestVessels(const formats::CenterlineTree& tree,
                       const std::vector<convert::SeedBranch>& seeds,
                       std::vector<convert::SeedFailure>& failures);

/// "the wall of the nearest vessel, "ica", is 1.3 mm away", or the vessel that holds the place, mm,
/// LPS; empty if there is none.
std::string nearestText(const formats::CenterlineTree& tree, const Eigen::Vector3d& place);

}  // namespace lumen::operations
