// SPDX-License-Identifier: Apache-2.0
// Plausibility of a measured value.
#pragma once

#include <algorithm>
#include <cmath>

namespace lumen::convert {

/// A range of values that is usual, and how fast plausibility falls beyond it.
struct Usual {
  double low, high, soft;
  /// 1 within the range, falling as a normal distribution beyond it.
  [[nodiscard]] double operator()(double x) const {
    const double beyond = std::max({low - x, x - high, 0.0}) / soft;
    return std::exp(-0.5 * beyond * beyond);
  }
};

}  // namespace lumen::convert
