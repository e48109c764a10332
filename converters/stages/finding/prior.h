// SPDX-License-Identifier: Apache-2.0
// Knowledge about a volume before vessels are found in it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumen::convert {

/// Statements of label maps about the voxels of a volume. A map is coarse, so that walls are none
/// of its business: it says what is bright there, and the volume where that ends.
struct Prior {
  static constexpr std::uint8_t kNothing = 0, kNoVessel = 255;

  /// For each voxel kNothing, kNoVessel, or the number of the system of vessels whose lumen is
  /// there, from 1: arteries and veins, say, which touch and are never joined. Empty if nothing is
  /// known.
  std::vector<std::uint8_t> systems;

  [[nodiscard]] bool isNoVessel(std::size_t voxel) const {
    return !systems.empty() && systems[voxel] == kNoVessel;
  }
  [[nodiscard]] bool isLumen(std::size_t voxel) const {
    return !systems.empty() && systems[voxel] != kNothing && systems[voxel] != kNoVessel;
  }
};

}  // namespace lumen::convert
