// SPDX-License-Identifier: Apache-2.0
// The vessel under a click, at once.
#pragma once

#include <string>

#include <Eigen/Core>

#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {

struct VesselAtClick {
  bool found = false;
  /// on the axis, mm, LPS; the click if none is found
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, along the vessel, either way
  double radius = 0;   ///< mm, of the wall as tracking corrects it
  std::string reason;  ///< the reason if nothing was found
};

/// The cylinder with which a track would begin at a click: fitted there, or at the brightest place
/// (darkest, if vessels are dark) within two voxels. Equal clicks give equal answers.
VesselAtClick vesselAtClick(const TrackingVolume& volume, const Eigen::Vector3d& click);

}  // namespace lumen::convert
