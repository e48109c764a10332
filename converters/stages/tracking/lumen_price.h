// SPDX-License-Identifier: Apache-2.0
// The price of a path through the volume: what keeps minimal paths within the lumen.
#pragma once

#include <cmath>

namespace lumen::convert {

/// Intensities, bright or dark as the vessels are: of the lumen's middle, and halfway down its wall.
struct LumenLevels {
  double middle = 0, wall = 0;
};

constexpr double kAtWallPrice = 8;       ///< of a millimetre at the wall's level
constexpr double kBeyondWallPrice = 60;  ///< of a millimetre beyond it

/// The price of a millimetre at an intensity: 1 in the lumen's middle, up to the wall's level more
/// with the square of what the middle is missed by, and much more beyond.
inline double lumenPrice(const LumenLevels& levels, double value) {
  const double range = levels.middle - levels.wall;
  const double missed = range != 0 ? (levels.middle - value) / range : 0;
  if (std::isnan(value)) return kBeyondWallPrice;
  if (missed <= 0) return 1;
  return missed < 1 ? 1 + (kAtWallPrice - 1) * missed * missed : kBeyondWallPrice;
}

}  // namespace lumen::convert
