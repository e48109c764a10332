// SPDX-License-Identifier: Apache-2.0
// What of the volume the case gets wrong: dark voxels inside of it, and bright ones that belong to
// its vessels and lie outside (docs/method.md, section 7.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/check/lumen_voxels.h"
#include "converters/common/progress.h"
#include "converters/volume/volume.h"

namespace lumen::convert {

/// A connected group of voxels.
struct Place {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS: the middle of its longest way
  std::uint32_t node = 0;  ///< of the case: inside of which it lies, or from which it was reached
  std::size_t voxels = 0;
  double volume = 0;  ///< mm^3
  double length = 0;  ///< mm, of its longest way
  double radius = 0;  ///< mm, of the cylinder of that length and volume
};

struct Places {
  double volume = 0;          ///< mm^3, of all such voxels, in places or not
  std::vector<Place> places;  ///< the longest first
};

/// How the grid of a volume is searched.
struct Levels {
  const Volume& volume;
  bool dark;                    ///< vessels are darker than their background
  std::span<const float> half;  ///< for each node, brighter is more: negative for dark vessels
};

/// Voxels inside, deeper than a voxel, that are darker than the half level of their node. A place
/// has at least four voxels.
Places darkInside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress);

/// Voxels outside that are brighter than the half level of the node from which they are reached
/// through such voxels, farther than two voxels from the lumen. A place has at least 20 voxels and
/// is at least four voxels long.
Places brightOutside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress);

}  // namespace lumen::convert
