// SPDX-License-Identifier: Apache-2.0
// The contrast of vessels along a tree (docs/method.md, section 2.11). In the image of a vessel that is
// narrower than the blur, contrast and radius are confounded: the wider vessels around it know the
// contrast.
#pragma once

#include <vector>

#include "converters/stages/fitting/image/section_fit.h"
#include "formats/case/case.h"

namespace lumen::convert::fitting {

/// For each node the contrast that its neighbours along the tree let expect, without its own
/// measurement. The contrast is a random walk along the edges: exact Gaussian inference by messages
/// from the tips to the roots and back. `measured`: one for each node; a deviation of 0 or less is no
/// measurement. `voxel`: mm. Empty if there is no measurement.
std::vector<Estimate> contrastAlong(const formats::CenterlineTree& tree,
                                    const std::vector<Estimate>& measured, double voxel);

}  // namespace lumen::convert::fitting
