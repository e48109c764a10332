// SPDX-License-Identifier: Apache-2.0
// The bright voxels outside of a case that are connected with its lumen (docs/method.md, section
// 7.2).
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "converters/base/progress.h"
#include "converters/judge/check/lumen_voxels.h"
#include "converters/judge/check/wall_offsets.h"
#include "converters/voxels/volume.h"
#include "converters/voxels/voxel_set.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Criteria for the voxels of a volume.
struct Levels {
  const Volume& volume;
  bool dark;  ///< vessels are darker than their background
  std::span<const NodeLevels> node;
};

/// Calls visit(value), where value(i) is the intensity of voxel i, brighter is more.
template <class Visit>
void withVoxels(const Levels& levels, Visit&& visit) {
  std::visit(
      [&](const auto& voxels) {
        visit([&voxels, dark = levels.dark](std::size_t i) {
          const auto value = static_cast<float>(voxels[i]);
          return dark ? -value : value;
        });
      },
      levels.volume.voxels);
}

/// Voxels outside, reached from the lumen through their 26 neighbours, that are brighter than the
/// half level of the node where the path began and than the faint level of the node nearest to
/// them.
struct BrightRegion {
  VoxelSet voxels;
  std::vector<std::uint32_t> node;   ///< for each voxel: node where its path began
  std::vector<std::uint32_t> order;  ///< all voxels as they were reached, nearest first
  std::size_t rim = 0;               ///< number of these that touch the lumen
  std::vector<float> depth;          ///< mm to the nearest voxel that is not bright
  std::vector<std::uint8_t>
      wide;  ///< 1: in a region too wide for a vessel, or reached only through one
};

/// The bright region; a part that holds a ball of radius `widest`, mm, is too wide. Throws
/// Error(Cancelled).
BrightRegion growBrightRegion(const LumenVoxels& lumen, const Levels& levels,
                              const formats::CenterlineTree& tree, double widest,
                              const Progress& progress);

}  // namespace lumen::convert
