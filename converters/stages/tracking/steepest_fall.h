// SPDX-License-Identifier: Apache-2.0
// The wall on one ray (docs/method.md, section 1.2).
#pragma once

#include <span>

namespace lumen::convert {

/// Where intensity falls fastest along a line of samples.
struct SteepestFall {
  double sample = 0;    ///< position in samples, between them by a parabola
  float strength = -1;  ///< difference of the two samples around; negative if there is none
};

/// The steepest fall by central differences; the first of several. `values`: NaN outside of the
/// volume, and inside of it in one stretch; a line that begins outside has no fall. `sign`: 1, or -1
/// if vessels are darker than their background. A fall within two samples of an end, or
/// three of the volume's, has no differences on both sides, and counts as none.
SteepestFall steepestFall(std::span<const float> values, float sign);

}  // namespace lumen::convert
