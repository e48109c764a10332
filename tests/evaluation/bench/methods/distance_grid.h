// SPDX-License-Identifier: Apache-2.0
// Distances to a vessel's wall on a dense grid.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "method.h"

namespace lumen::bench {

/// Value (i, j, k) is at low + cell (i, j, k), and element i + size[0] (j + size[1] k).
struct DistanceGrid {
  double cell = 0.2;  ///< mm
  std::array<double, 3> low{};
  std::array<std::size_t, 3> size{};
  std::vector<float> value;  ///< mm, negative in the lumen

  DistanceGrid() = default;
  /// Around the vessel and a millimetre beyond, by libblob, each node found anew.
  explicit DistanceGrid(const Vessel& vessel);
};

}  // namespace lumen::bench
