// SPDX-License-Identifier: Apache-2.0
// Smooth vessels in place of centerlines that were traced by hand.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/phantom/design.h"

namespace lumen::convert {

struct SmoothVessel {
  std::int32_t parent = formats::kNoParent;  ///< index of a vessel before this one
  Path path;                                 ///< points about `step` apart
};

/// One vessel for each chain of the file, in the order of centerlineChains(). Positions are smoothed by a
/// Gaussian of 1.5 samples that leaves both ends where they are, and joined by a natural cubic
/// spline over the chord lengths; a child begins on the spline of its parent. Radii are smoothed by
/// the same Gaussian and joined by a monotone cubic (Fritsch and Butland, "A method for
/// constructing local monotone piecewise cubic interpolants", 1984), so that a jump becomes a slope
/// and no radius leaves the range of its neighbours. The radius at a child's start is its own, not
/// its parent's.
std::vector<SmoothVessel> smoothVessels(const CenterlineFile& file, double step);

}  // namespace lumen::convert
