// SPDX-License-Identifier: Apache-2.0
// State that a search for the nearest triangle may keep from step to step: the wall is no farther than its
// last distance and the path of the point since.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "closest_point.h"

namespace lumen::bench {

class LastStep {
public:
  void assign(std::size_t count) {
    m_point.assign(count, {});
    m_distance.assign(count, std::numeric_limits<float>::infinity());
  }

  /// A bound on the distance of point i, now at p, mm; infinite in its first step.
  [[nodiscard]] float reach(std::size_t i, const float* p) const {
    constexpr float kRounding = 1e-4f;
    const float moved = std::sqrt(squareOf(p, m_point[i].data()));
    return (m_distance[i] + moved) * (1 + kRounding) + kRounding;
  }

  void keep(std::size_t i, const float* p, double distance) {
    m_point[i] = {p[0], p[1], p[2]};
    m_distance[i] = std::abs(static_cast<float>(distance));
  }

private:
  std::vector<std::array<float, 3>> m_point;
  std::vector<float> m_distance;
};

}  // namespace lumen::bench
