// SPDX-License-Identifier: Apache-2.0
// The measures of aneurysms (docs/measures.md, section Aneurysms).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/judge/measure/measured.h"
#include "formats/case/case.h"

namespace lumen::convert {

class WallNoise;

/// An aneurysm with its lobes. Lengths in mm, angles in degrees.
struct SacMeasures {
  std::uint32_t branch = 0;        ///< the one that hangs on a vessel
  std::string_view position = {};  ///< "side-wall" or "bifurcation"; empty without a vessel
  /// Centroid of the neck's section; without a neck, the middle of the sac.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d neckNormal = Eigen::Vector3d::Zero();  ///< unit, into the dome; zero without
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();         ///< farthest from `place`
  std::vector<Eigen::Vector3d> rim = {};                 ///< of the neck, in order
  Measured neckDiameter, neckArea, height, reach, width, volume, area, aspectRatio, sizeRatio,
      bottleneckFactor, undulation, ellipticity, nonSphericity, inflowAngle;
};

/// All aneurysms of a valid case, in the order of their branches. Where a measure is not defined, it
/// states the reason. `noise`: of the case's wall; null without models. Throws Error(Cancelled).
std::vector<SacMeasures> measureSacs(const formats::Case& source, const WallNoise* noise,
                                     const Progress& progress);

}  // namespace lumen::convert
