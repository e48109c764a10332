// SPDX-License-Identifier: Apache-2.0
// A measure with its uncertainty.
#pragma once

#include <limits>
#include <string_view>

namespace lumen {

/// One number with its uncertainty, or the reason why there is none.
struct Measured {
  double value = std::numeric_limits<double>::quiet_NaN();
  /// half of the 95 % interval, in the unit of the value; NaN where it is not known
  double plusMinus = std::numeric_limits<double>::quiet_NaN();
  /// why the value is not defined here; empty where it is
  std::string_view absent = {};
};

}  // namespace lumen
