// SPDX-License-Identifier: Apache-2.0
// A picture of a volume with the tree of a case, coloured by how well they agree.
#pragma once

#include <string>
#include <vector>

#include "converters/draw/raster/picture.h"
#include "converters/judge/check/check.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Maximum-intensity projections (minimum, for dark vessels) as front, side and top view, over them
/// the centerlines in the colour of their nodes' agreement, names of branches where they end and
/// where there is room, and missing vessels, the longest ones numbered as in the legend.
Picture drawOverlay(const Volume& volume, const formats::CenterlineTree& tree,
                    const CheckReport& report);

/// One of its views on a picture of its own.
struct OverlayPanel {
  std::string title;  ///< "x right, z up"
  Picture picture;
};
/// The three views for paper, all of one scale: without a legend, and with larger letters.
std::vector<OverlayPanel> drawOverlayPanels(const Volume& volume,
                                            const formats::CenterlineTree& tree,
                                            const CheckReport& report);

/// The colours of these pictures.
Rgb colourOf(Agreement agreement);
inline constexpr Rgb kMissingColour{255, 80, 255};

}  // namespace lumen::convert
