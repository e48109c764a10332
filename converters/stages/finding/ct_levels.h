// SPDX-License-Identifier: Apache-2.0
// Levels of tissue in a volume of computed tomography (docs/method.md, section 1.13).
#pragma once

#include <optional>

#include "converters/base/progress.h"
#include "converters/voxels/neighbourhood.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Levels of a volume of computed tomography without contrast, voxel units, which are Hounsfield
/// units but for a constant.
struct CtLevels {
  /// Blood with contrast is so much brighter than soft tissue, Hounsfield units; without it, blood
  /// is soft tissue.
  static constexpr float kLeastContrast = 100;
  /// Multiples of the noise that noise alone hardly ever makes of it.
  static constexpr float kCalm = 2;
  /// Blood with contrast is hardly ever so much brighter.
  static constexpr float kMostContrast = 450;

  float noise = 0;  ///< usual standard deviation around a voxel of soft tissue
  float soft = 0;   ///< soft tissue, and blood without contrast

  /// Whether the voxels around a place have one level, as within a lumen, and unlike bone.
  [[nodiscard]] bool isCalm(const Neighbourhood& around) const {
    return around.deviation < kCalm * noise;
  }
};

/// The levels of a volume whose calm voxels show that it is computed tomography: most are soft
/// tissue or fat, and there is air or fat beside them at the distance that Hounsfield's scale has.
/// The scale may be moved by 1000 or 1024. Empty for all other volumes. Throws Error(Cancelled).
std::optional<CtLevels> measureCtLevels(const Volume& volume, const Progress& progress);

}  // namespace lumen::convert
