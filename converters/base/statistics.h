// SPDX-License-Identifier: Apache-2.0
// Order statistics. The definitions of a median and of a quantile differ by which elements of a
// short list they take, and results depend on it to the last bit: each has a name of its own here.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lumen {

/// Standard deviation of a normal distribution, in medians of absolute deviations.
constexpr double kDeviationOfMedian = 1.4826;

/// Half the sum of the two middle values, or the middle one; of a non-empty list.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// The value that `rank` others precede in ascending order (0: the least); reorders the list.
template <typename T>
T valueAtRank(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle value, or the upper one of the two; of a non-empty list, which it reorders.
template <typename T>
T upperMedian(std::vector<T>& values) {
  return valueAtRank(values, values.size() / 2);
}

/// The value at the share `share` (in [0, 1]) from the least to the greatest, by rank rounded down;
/// of a non-empty list, which it reorders.
template <typename T>
T lowerQuantile(std::vector<T>& values, double share) {
  return valueAtRank(values,
                     static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// The nearest rank: the least value that at least `share` (in [0, 1]) of the values do not exceed;
/// of a non-empty list, which it reorders.
template <typename T>
T nearestRank(std::vector<T>& values, double share) {
  constexpr double kRoundoff = 1e-9;  // ranks: 0.9 * 10 is 9, despite its last bit
  const auto rank =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()) - kRoundoff));
  return valueAtRank(values, std::max<std::size_t>(rank, 1) - 1);
}

}  // namespace lumen
