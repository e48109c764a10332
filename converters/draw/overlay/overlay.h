// SPDX-License-Identifier: Apache-2.0
// A picture of a volume with the tree of a case, coloured by how well they agree.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/draw/raster/picture.h"
#include "converters/judge/check/check.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Projections of a volume along the axes of its grid, laid out as front, side and top view.

/// A projection along one axis of the index space, in the picture. Axes are those of the grid; an
/// axis is flipped where it runs against the view.
struct Panel {
  int across, down, along;  ///< axes
  bool flipAcross = false, flipDown = false;
  double right = 1, below = 1;              ///< pixels for a voxel
  int x = 0, y = 0, width = 0, height = 0;  ///< pixels
  std::array<int, 3> size{};                ///< the volume's, voxels
  std::string title{};                      ///< "x right, z up"

  [[nodiscard]] std::array<double, 2> pixel(const Eigen::Vector3d& index) const;
};

struct Layout {
  std::array<Panel, 3> panels;
  int width = 0, height = 0;     ///< the picture's
  int legendX = 0, legendY = 0;  ///< place of the legend
};

/// Front view (x to the right, z up), beside it the side view (y to the right, z up), below it the
/// view from the feet (x to the right, y down), all of one scale; these directions hold as far as
/// the axes of the grid follow those of the patient. The legend is in the fourth quarter, of at
/// least that size, pixels.
Layout layOut(const VolumeGeometry& geometry, int gap, int legendWidth, int legendHeight);

struct Projection {
  int width = 0, height = 0;  ///< voxels
  std::vector<float> values;  ///< rows from the top
  /// Linear between the centres of voxels; a place in voxels from the upper left corner.
  [[nodiscard]] float at(double across, double down) const;
};

/// The greatest value, times `sign`, of each line of voxels along the panel's axis.
Projection project(const Volume& volume, const Panel& panel, float sign);

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
