// SPDX-License-Identifier: Apache-2.0
// Projections of a volume along the axes of its grid, laid out as front, side and top view.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/voxels/volume.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
