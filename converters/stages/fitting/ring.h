// SPDX-License-Identifier: Apache-2.0
// Directions spread evenly around an axis, the same on every machine.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace lumen::convert::fitting {

constexpr std::size_t kRingSize = 16;

/// Cosines of multiples of a sixteenth of a turn; the C library's differ between machines.
inline constexpr std::array<double, kRingSize> kRingCosine = {
    1,  0.92387953251128674,  0.70710678118654752,  0.38268343236508977,
    0,  -0.38268343236508977, -0.70710678118654752, -0.92387953251128674,
    -1, -0.92387953251128674, -0.70710678118654752, -0.38268343236508977,
    0,  0.38268343236508977,  0.70710678118654752,  0.92387953251128674};

/// The unit vector i sixteenths of a turn from `u` towards `v`, which are orthonormal.
inline Eigen::Vector3d ringDirection(std::size_t i, const Eigen::Vector3d& u,
                                     const Eigen::Vector3d& v) {
  return kRingCosine[i] * u + kRingCosine[(i + 3 * kRingSize / 4) % kRingSize] * v;
}

}  // namespace lumen::convert::fitting
