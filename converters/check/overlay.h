// SPDX-License-Identifier: Apache-2.0
// A picture of a volume with the tree of a case, coloured by how well they agree.
#pragma once

#include "converters/check/check.h"
#include "converters/check/picture.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Maximum-intensity projections (minimum, for dark vessels) as front, side and top view, over them
/// the centerlines in the colour of their nodes' agreement, names of branches where they end and where
/// there is room, and missing vessels, the longest ones numbered as in the legend.
Picture drawOverlay(const Volume& volume, const formats::CenterlineTree& tree,
                    const CheckReport& report);

}  // namespace lumen::convert
