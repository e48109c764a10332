// SPDX-License-Identifier: Apache-2.0
// Least, mean and greatest radius, as answers and records of libraries state them.
#pragma once

#include <algorithm>
#include <span>

namespace lumen {

struct RadiusRange {
  float min = 0, mean = 0, max = 0;  ///< mm
};

/// Range of at least one radius.
inline RadiusRange radiusRange(std::span<const float> radii) {
  double sum = 0;
  for (const float r : radii) sum += static_cast<double>(r);
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  return {*low, static_cast<float>(sum / static_cast<double>(radii.size())), *high};
}

}  // namespace lumen
