// SPDX-License-Identifier: Apache-2.0
// The models that fits begin with (docs/method.md, section 2.6).
#pragma once

#include <vector>

#include "converters/stages/fitting/node_data.h"

namespace lumen::convert::fitting {

/// The node's own start, or two blobs half way to the ends of the points along its direction.
/// Farther out they would bulge beyond the points of an open end, where no point pulls them back.
std::vector<Blob> placeAlongVessel(const EnergyParameters& parameters, const NodeData& node);

/// A blob in every inscribed ball that is not mostly in another one's.
std::vector<Blob> placeInLumen(const EnergyParameters& parameters, std::span<const FitBall> lumen);

}  // namespace lumen::convert::fitting
