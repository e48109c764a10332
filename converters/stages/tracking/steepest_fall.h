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

/// The steepest fall by central differences, up to the first sample that is NaN, as those outside of
/// the volume are; the first of several. `sign`: 1, or -1 if vessels are darker than their background. A
/// fall within two samples of an end, or three of a NaN, counts as none.
SteepestFall steepestFall(std::span<const float> values, float sign);

}  // namespace lumen::convert
