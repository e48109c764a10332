// SPDX-License-Identifier: Apache-2.0
// Label maps as programs write them: floats beside whole numbers, and another background than 0.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "converters/voxels/volume.h"

namespace lumen::convert {

struct SettledLabels {
  Volume voxels;
  std::vector<std::string> remarks;  ///< what was settled, a sentence each
};

/// A map whose voxels all lie within 0.001 of whole numbers up to 2^24, rounded; and whose only negative
/// number, which marks no label, becomes 0 if it is -1 or if no voxel is 0. Empty for a map in which
/// nothing changes, for other volumes, and for a negative number among the labels that a person
/// chose.
std::optional<SettledLabels> settleLabels(const Volume& volume,
                                          const std::set<std::int64_t>& chosen);

}  // namespace lumen::convert
