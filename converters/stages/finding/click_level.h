// SPDX-License-Identifier: Apache-2.0
// Clicks at which a volume shows nothing.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/stages/finding/background.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Intensities at a click, in units of the voxels.
struct ClickLevel {
  double value = 0;       ///< mean of the voxel at the click and of those that touch it
  double background = 0;  ///< around the click
  double quiet = 0;       ///< of the quarter of the volume with the least background
  double noise = 0;       ///< standard deviation

  /// The click is in the background as far as the noise of one voxel lets see. The mean of 27 voxels
  /// varies less than one of them, so noise hides no vessel of twice its contrast.
  /// Around the middle of a vessel as wide as many blocks all background is vessel, and that of the
  /// whole volume shows it.
  [[nodiscard]] bool isDark() const {
    return std::abs(value - background) <= noise && std::abs(value - quiet) <= noise;
  }
};

/// Compares clicks with the background of their volume, which must outlive it.
class ClickLevels {
public:
  /// Throws Error(Cancelled).
  ClickLevels(const Volume& volume, bool areVesselsDark, const Progress& progress);

  /// The level at a place, mm, LPS, within the volume or at its border.
  [[nodiscard]] ClickLevel at(const Eigen::Vector3d& place) const;

private:
  const Volume& m_volume;
  double m_sign;
  Background m_background;
  double m_quiet = 0;
};

}  // namespace lumen::convert
