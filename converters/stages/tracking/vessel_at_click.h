// SPDX-License-Identifier: Apache-2.0
// The vessel under a click, at once.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

// Clicks that lie in vessels, by the intensity around them.

/// Judges clicks by their contrast with their surroundings, compared with that of places all over
/// the volume.
class ClickLight {
public:
  /// Samples the contrast of the volume. The arguments must outlive the object. Throws
  /// Error(Cancelled).
  ClickLight(const Volume& volume, const TrackOptions& options, const Progress& progress);

  /// The seeds whose first point lies in a vessel, as far as its contrast shows. Throws
  /// Error(Cancelled).
  [[nodiscard]] std::size_t countInVessels(const std::vector<SeedBranch>& seeds) const;

private:
  [[nodiscard]] double contrastAt(const SeedBranch& seed) const;

  BsplineVolume m_spline;
  const TrackOptions& m_options;
  const Progress& m_progress;
  double m_usual = 0;  ///< contrast that a tenth of the volume's places exceed
};

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
