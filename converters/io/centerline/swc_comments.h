// SPDX-License-Identifier: Apache-2.0
// Comments of SWC files that state unit, axes and scale of the points.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// Facts that comments state on all points.
class SwcComments {
public:
  /// Reads a comment, without its #. A unit counts where the comment speaks of units, positions,
  /// coordinates, radii or columns, and not of voxels or pixels: "All positions and radii in um",
  /// "x (um)", "units: 8 nanometer". The last of several counts.
  void read(std::string_view comment);

  /// Applies scale, unit and axes to a file, with remarks on the unit and on the scale.
  void apply(CenterlineFile& file) const;

private:
  void readScale(std::string_view comment);

  double m_unit = 0;  // mm; 0: not stated
  std::string m_unitWords;
  Eigen::Vector3d m_scale = Eigen::Vector3d::Ones();
  std::string m_badScale;
  CenterlineAxes m_axes = CenterlineAxes::Unknown;
};

}  // namespace lumen::convert
