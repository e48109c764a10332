// SPDX-License-Identifier: Apache-2.0
// The seam of the models of two adjacent nodes (docs/method.md, section 2.7): the radical plane, on
// which both have the same power |X - C|^2 - r^2.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/fitting/levenberg_marquardt.h"

namespace lumen::convert::fitting {

// Directions spread evenly around an axis, the same on every machine.

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

/// A node and its model. All centres are in one frame; the blobs are in the frame of their node.
struct SeamSide {
  FitBall node;
  std::span<const Blob> blobs;
};

/// Rays per seam.
constexpr std::size_t kSeamRays = kRingSize;

/// Points between the two surfaces, along rays in the radical plane, in the frame of the centres:
/// at most kSeamRays. `share`: position of the points, as a share of the distance from the first
/// surface to the second; halfway for two that move. None where a ray meets one of the surfaces
/// only, where they are farther apart than half of the narrower radius, or where one of `others`
/// has a smaller power.
std::vector<formats::Vec3d> seamPoints(const EnergyParameters& parameters, const SeamSide& first,
                                       const SeamSide& second, std::span<const FitBall> others,
                                       double share = 0.5);

}  // namespace lumen::convert::fitting
