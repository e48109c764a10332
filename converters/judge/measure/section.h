// SPDX-License-Identifier: Apache-2.0
// Figures of a cross-section of the wall (docs/measures.md, section 3).
#pragma once

#include <Eigen/Core>

#include "converters/judge/measure/wall.h"

namespace lumen::convert {

struct Section {
  double area = 0;       ///< mm^2
  double perimeter = 0;  ///< mm
  /// Distance of two parallel lines that touch the section on either side, mm.
  double least = 0, greatest = 0;
  double circularity = 0;                              ///< 4 pi area / perimeter^2: 1 for a circle
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< mm
  /// Volume and area of the wall for each mm along an axis of this curvature vector (normal times
  /// curvature, 1/mm), by Pappus.
  double volumeRate = 0, wallRate = 0;
};

/// The figures of a closed ring. `bend`: the axis' curvature vector, 1/mm.
Section sectionOf(const CutPlane& plane, const WallRing& ring, const Eigen::Vector3d& bend);

}  // namespace lumen::convert
