// SPDX-License-Identifier: Apache-2.0
// A picture of a volume with the tree of a case, coloured by how well they agree.
#pragma once

#include "converters/check/check.h"
#include "converters/check/picture.h"
#include "converters/volume/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Maximum-intensity projections (minimum, for dark vessels) along the volume's k, j and i axis, side
/// by side with equal scale, the centerlines in the colour of their nodes' agreement over them, and a legend below.
Picture drawOverlay(const Volume& volume, const formats::CenterlineTree& tree,
                    const CheckReport& report);

}  // namespace lumen::convert
