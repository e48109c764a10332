// SPDX-License-Identifier: Apache-2.0
// Voxels of ridges beside the lumen (docs/method.md, section 1.13).
#pragma once

#include <cstdint>
#include <vector>

#include "converters/base/progress.h"
#include "converters/base/zeroed_array.h"
#include "converters/voxels/cell_box.h"

namespace lumen::convert {

/// A voxel may be background, a part of a vessel if it is connected with lumen, lumen, or other
/// tissue that shows nothing of the background.
enum Mark : std::uint8_t { kBackground = 0, kWeak = 1, kLumen = 2, kOtherTissue = 3 };

/// Multiples of the usual ridge: a vessel has one voxel of the latter at least, and goes on through
/// voxels of the former. In white noise one voxel of 1000 exceeds 3.2, and none of 885,000 5.6.
constexpr float kWeakRidge = 3.2F, kStrongRidge = 8;

/// The usual strength of the ridges in the background, by blocks of voxels: of noise and texture.
class UsualRidges {
public:
  /// `strength` (ridgeStrength()) and `mark` have a value for each cell. Throws Error(Cancelled).
  UsualRidges(const CellBox& cells, const ZeroedArray<float>& strength,
              const ZeroedArray<std::uint8_t>& mark, const Progress& progress);

  /// The strength around a voxel.
  [[nodiscard]] float at(const Cell& cell) const;

private:
  std::vector<float> m_median;
  CellBox m_blocks;
};

/// Adds the weak ridges that are connected with the lumen. Throws Error(Cancelled).
void growIntoWeak(const CellBox& cells, ZeroedArray<std::uint8_t>& mark, const Progress& progress);

}  // namespace lumen::convert
