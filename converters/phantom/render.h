// SPDX-License-Identifier: Apache-2.0
// From a design to voxels.
#pragma once

#include <cstdint>
#include <vector>

#include "converters/common/progress.h"
#include "converters/phantom/design.h"

namespace lumen::convert {

/// Intensity far from vessels, before bias and noise.
constexpr double kBackground = 100;
/// What a vessel that fills a voxel adds to the background.
constexpr double kContrast = 1000;

/// A cube of n^3 voxels, x fastest.
struct Cube {
  int n = 0;
  std::vector<float> value;
  float* row(int y, int z) {
    return value.data() + (static_cast<std::size_t>(z) * n_() + static_cast<std::size_t>(y)) * n_();
  }

private:
  [[nodiscard]] std::size_t n_() const { return static_cast<std::size_t>(n); }
};

/// For each voxel the share of it that lies in the lumen, times the local contrast of the design,
/// in [0, 1]. Voxels that the wall may cross are integrated over 27 subvoxels, each weighted by its
/// own signed distance.
Cube drawOccupancy(const Design& design, const Frame& frame, int size, Progress& progress);

/// Convolves in place with a Gaussian of standard deviation `sigma` voxels, cut at 4 sigma and
/// normalised; voxels beyond a face equal those on it.
void blur(Cube& cube, double sigma, Progress& progress);

/// kBackground + kContrast * (occupancy + bias field + noise), rounded. The bias field is a mean of
/// four plane waves of random direction and phase with 0.5 to 1.5 periods across the cube, so it
/// lies in [-bias, bias]. The noise of a row depends on `seed` and the row only.
std::vector<std::int16_t> degrade(Cube& cube, double bias, double noise, std::uint64_t seed,
                                  Progress& progress);

/// A normal deviate to an excess kurtosis of -0.016, bounded to +-11.5, made from integer
/// arithmetic so that every machine gives the same bits: the centred count of 128 fair bits plus
/// two uniform deviates.
double countedNormal(Random& random);

}  // namespace lumen::convert
