// SPDX-License-Identifier: Apache-2.0
// Whether the volume supports the wall that a node was given (docs/method.md, section 1.11).
#pragma once

#include <Eigen/Core>

#include "converters/stages/tracking/tracked_branch.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

/// The contents of a node's cylinder.
struct WallSupport {
  double dark = 0;  ///< share of the inside that is beyond the level of the node's wall, in [0, 1]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mm, LPS, of the lumen nearest to `guess`
  double radius = 0;                                 ///< mm, of a disc as large as all of its lumen
};

/// Samples the inside of a node, up to four fifths of its radius, and compares it with the median
/// intensity at its wall points. A wall around a vessel holds lumen only; a wall that takes in the
/// gap to a neighbour, or that bulges into the dark, does not. `dark`: vessels are darker than
/// their background. Without points all of the inside counts as lumen. `guess`: the expected place
/// of the vessel, mm, LPS; of several lumens inside, `middle` is that of the nearest.
WallSupport wallSupport(const BsplineVolume& volume, const TrackedNode& node,
                        const Eigen::Vector3d& guess, bool dark);

/// True if so little of the inside is dark that the node's wall is one vessel's.
bool isSupported(const WallSupport& support);

}  // namespace lumen::convert
