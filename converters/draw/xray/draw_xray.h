// SPDX-License-Identifier: Apache-2.0
// The X-ray of a case, without a display.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "converters/base/progress.h"
#include "converters/draw/raster/picture.h"
#include "converters/draw/xray/xray_view.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct XrayOptions {
  XrayView view;                             ///< pixel 0: as of pixelFor()
  std::optional<Eigen::Vector3d> isocentre;  ///< mm, LPS; absent: middleOf() the vessels
  double peak = 80;                          ///< of the tube, kV
  double filter = 2.5;                       ///< mm of aluminium
  double iodine = 300;                       ///< of the contrast agent in the lumen, mg/ml
  double tissue = 180;                       ///< mm of water on each ray, without a volume
  double scatter = 0;  ///< over the mean primary radiation; even over the picture
  double photons = 0;  ///< for each pixel of the bare beam; 0: without noise
  bool isSubtracted = false;
  std::uint64_t seed = 1;  ///< of the noise
};

/// Rows from the top.
struct XrayImage {
  XrayView view;  ///< as it was used
  /// -ln of the energy that arrives over that of the bare beam; with a subtraction, what the contrast
  /// agent adds to it.
  std::vector<float> attenuation;
  double longest = 0;      ///< longest path of a ray in the lumen, mm
  double lumenShare = 0;   ///< of the pixels, with a path in the lumen
  double lumenVolume = 0;  ///< mm^3 of the lumen that the picture shows
  double meanEnergy = 0;   ///< keV, of the bare beam
};

/// Computed tomography around the vessels.
struct TissueScan {
  const Volume* volume = nullptr;  ///< null: water
  double offset = 0;               ///< what its values exceed Hounsfield units by
};

/// The offset of a volume. Throws Error(InvalidInput) for one that is no computed tomography, and
/// Error(Cancelled).
double unitOffset(const Volume& volume, const Progress& progress);

/// The X-ray of a case, whose lumen is full of contrast agent, in a volume of computed tomography
/// whose lumen it takes the place of, or in water. Bits do not depend on the number of threads.
/// Throws Error(InvalidInput) for a case without models or a node and for vessels that do not lie
/// between source and detector; Error(Cancelled).
XrayImage xrayOf(const formats::Case& source, const XrayOptions& options, const TissueScan& scan,
                 Progress& progress);

/// The picture as people know it: the more is attenuated, the darker, from the thousandth of the
/// values to the last but as many.
Picture shadedXray(const XrayImage& image);

/// The values as a volume of one slice in the place of the detector.
Volume detectorVolume(const XrayImage& image);

}  // namespace lumen::convert
