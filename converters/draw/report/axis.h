// SPDX-License-Identifier: Apache-2.0
// The axis of a plot.
#pragma once

#include <vector>

namespace lumen::convert {

/// An axis from 0 to `end`; marks are multiples of 1, 2 or 5 times a power of ten.
struct Axis {
  double end = 1;
  std::vector<double> marks;  ///< 0 is the first
  int digits = 0;             ///< behind the decimal point of a mark
};

/// The axis with one mark besides 0 at least, and at most `most`, which is at least 3. An `end`
/// that is not above 0, or is not finite, becomes 1.
Axis axisTo(double end, int most);

}  // namespace lumen::convert
