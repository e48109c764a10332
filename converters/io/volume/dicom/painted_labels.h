// SPDX-License-Identifier: Apache-2.0
// Structures that may overlap, as one map of labels.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Calls its argument for each voxel of a structure, by its index in the map.
using VoxelsOfStructure = std::function<void(const std::function<void(std::size_t)>&)>;

struct PaintedStructure {
  std::size_t label = 0;
  VoxelsOfStructure voxels;  ///< called twice
};

/// The map: a voxel of several structures is of the one with the fewest voxels, and of equal ones of the
/// first. A sentence among the assumptions counts such voxels.
Voxels paintedLabels(std::size_t count, const std::vector<PaintedStructure>& structures,
                     std::vector<std::string>& assumptions);

/// Labels of up to 255 as bytes, others as words of two bytes.
Voxels narrowLabels(std::vector<std::uint16_t> labels);

}  // namespace lumen::convert
