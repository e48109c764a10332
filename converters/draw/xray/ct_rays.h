// SPDX-License-Identifier: Apache-2.0
// Water and bone on the rays of an X-ray through computed tomography.
#pragma once

#include <span>

#include <Eigen/Core>

#include "converters/draw/xray/attenuation.h"
#include "converters/draw/xray/lumen_rays.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Matter along rays through a volume in Hounsfield units: a voxel above 0 HU is a mixture of water
/// and cortical bone that attenuates as much at 70 keV, one below 0 thin water.
class CtRays {
public:
  /// `volume` must stay. `offset`: what its values exceed Hounsfield units by.
  CtRays(const Volume& volume, double offset);

  /// The matter on a ray, but for the lumen's stretches, in which water stands for the blood.
  /// `direction`: unit. Steps of half of the least spacing, trilinear between voxels.
  [[nodiscard]] Matter along(const Eigen::Vector3d& source, const Eigen::Vector3d& direction,
                             double length, std::span<const Chord> lumen) const;

private:
  const Volume& m_volume;
  double m_offset;
};

}  // namespace lumen::convert
