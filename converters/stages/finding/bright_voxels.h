// SPDX-License-Identifier: Apache-2.0
// The voxels of a volume that are lumen as far as brightness and shape show it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "converters/base/progress.h"
#include "converters/base/zeroed_array.h"
#include "converters/stages/finding/bone_rim.h"
#include "converters/stages/finding/ct_levels.h"
#include "converters/stages/finding/prior.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

// Tubular voxels by the second derivatives of a volume (Y. Sato et al., "Three-dimensional
// multi-scale line filter", 1998; A. Frangi et al., "Multiscale vessel enhancement filtering",
// 1998).

/// Strength of the brightest ridge through each voxel over several scales: the lesser of the two
/// curvatures across it, times the variance of the Gaussian by which the volume was smoothed, in
/// voxel units; 0 where both ways across are not curved downward alike, or the way along is curved
/// as well. Vessels up to about three voxels of radius answer.
///
/// `sign`: 1, or -1 if vessels are darker than their background. Works on bricks, so that its
/// buffers do not grow with the volume. Throws Error(Cancelled).
ZeroedArray<float> ridgeStrength(const Volume& volume, float sign, const Progress& progress);

/// Fewer voxels show nothing: a cube of three.
constexpr std::size_t kSpeck = 27;

// Wide vessels that fade along their course (docs/method.md, section 1.13).

/// Excess of every voxel of a volume over its background, and what of it is lumen.
struct Excess {
  CellBox cells;
  ZeroedArray<float> value;                   ///< for each voxel; brighter is more
  std::function<float(const Cell&)> leastAt;  ///< the least value there that is no noise
};

/// Adds voxels of wide vessels that are less bright than those of the rest of the volume: from
/// block to block of 16 voxels, those that are connected to lumen and are brighter than half of
/// the lumen's median in their block, or in the brightest block beside it. A rim of vessels that
/// are known is left out. `isLumen`: a flag for each voxel. `contrast`: excess of the wide vessels
/// of the volume. Throws Error(Cancelled).
void growIntoFaded(const Excess& excess, float contrast, std::vector<bool>& isLumen,
                   const Progress& progress);

/// Lumen of a volume, before anything is known of its vessels.
struct BrightVoxels {
  std::vector<std::size_t> indices;  ///< ascending, x fastest
  std::vector<std::size_t> bone;     ///< the same: as bright, and no lumen
  bool isBoneKnown = false;          ///< `bone` was looked for, as in computed tomography
  /// In computed tomography, the volume with all that is brighter than blood as much darker; null in
  /// all others.
  std::shared_ptr<const Volume> folded;
  /// Where no wide vessel shows the level of blood: the rim of bone, and the strength of the ridges of `folded`.
  std::shared_ptr<const BoneRim> rim;
  std::shared_ptr<const ZeroedArray<float>> strength;
  double contrast = 0;  ///< excess of wide vessels over their background, voxel units
  double noise = 0;     ///< standard deviation of the background, voxel units
};

/// Voxels of wide vessels, which are brighter than halfway between their background and the wide
/// vessels of the volume; and those of thin ones, which lose brightness to blur, by the strength of
/// the ridge that they are on (docs/method.md, section 1.13). Empty if nothing stands out of the
/// noise. In computed tomography (ct_levels.h) wide vessels are those whose level is even, which
/// bone's is not, and thin ones are connected with them or lie amid soft tissue.
/// Voxels that are no image do not count. `dark`: vessels are darker than their background. `prior`: what is no vessel is no lumen; lumen needs no
/// more than to stand out of the noise, and nothing beside it. Throws Error(Cancelled).
BrightVoxels findBrightVoxels(const Volume& volume, bool dark, const Prior& prior,
                              const Progress& progress);

/// Whether voxels beside bone that may be thin lumen are found: tracks show which of them are.
enum class BesideBone : std::uint8_t { Refused, Followed };

/// The same in computed tomography.
BrightVoxels findCtLumen(const Volume& volume, const CtLevels& levels, const Prior& prior,
                         BesideBone beside, const Progress& progress);

}  // namespace lumen::convert
