// SPDX-License-Identifier: Apache-2.0
// Clicks that lie in vessels, by the intensity around them.
#pragma once

#include <cstddef>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/track_options.h"
#include "converters/voxels/bspline.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
