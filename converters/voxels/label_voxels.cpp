// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/label_voxels.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace lumen::convert {

bool holdsLabels(const Voxels& all) {
  return std::visit(
      [](const auto& voxels) {
        using T = typename std::decay_t<decltype(voxels)>::value_type;
        constexpr double kLargest = 1e9;  // far more labels than any volume has
        const auto isLabel = [](T v) {
          const auto value = static_cast<double>(v);
          return value >= 0 && value <= kLargest && value == std::floor(value);
        };
        if (!std::all_of(voxels.begin(), voxels.end(), isLabel)) return false;
        const bool hasBackground = std::find(voxels.begin(), voxels.end(), T{}) != voxels.end();
        const bool hasLabel =
            std::any_of(voxels.begin(), voxels.end(), [](T v) { return v != T{}; });
        return hasBackground && hasLabel && !isGrey(voxels);
      },
      all);
}

}  // namespace lumen::convert
