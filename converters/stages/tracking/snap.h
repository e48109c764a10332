// SPDX-License-Identifier: Apache-2.0
// The vessel under a click, at once.
#pragma once

#include <string>

#include <Eigen/Core>

#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {

struct Snap {
  bool found = false;
  Eigen::Vector3d position =
      Eigen::Vector3d::Zero();  ///< on the axis, mm, LPS; the click if none is found
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, along the vessel, either way
  double radius = 0;   ///< mm, of the wall as tracking corrects it
  std::string reason;  ///< why nothing was found
};

/// The cylinder that a track would begin with at a click: fitted there, or at the brightest place (darkest,
/// if vessels are dark) within two voxels. The same click gives the same answer.
Snap snapToVessel(const TrackingVolume& volume, const Eigen::Vector3d& click);

}  // namespace lumen::convert
