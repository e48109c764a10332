// SPDX-License-Identifier: Apache-2.0
// From a design to voxels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/stages/phantom/design.h"

namespace lumen::convert {

/// Intensity far from vessels, before bias and noise.
constexpr double kBackground = 100;
/// What a vessel that fills a voxel adds to the background.
constexpr double kContrast = 1000;

/// Where the voxels of a drawing are: `origin` is the centre of the first, axes are those of LPS.
struct Grid {
  std::array<int, 3> size{};                         ///< voxels along x, y, z
  double voxel = 0;                                  ///< mm, the edge of a voxel
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< mm
};

/// Values of voxels, x fastest.
struct Image {
  std::array<int, 3> size{};
  std::vector<float> value;
  float* row(int y, int z) {
    const auto n = static_cast<std::size_t>(size[0]);
    return value.data() + (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
                           static_cast<std::size_t>(y)) *
                              n;
  }
};

/// For each voxel the share of it that lies in the lumen, times the local contrast of the design,
/// in [0, 1]. Voxels that the wall may cross are integrated over 27 subvoxels, each weighted by its
/// own signed distance.
Image drawOccupancy(const Design& design, const Grid& grid, Progress& progress);

/// Convolves in place with a Gaussian of standard deviation `sigma` voxels, cut at 4 sigma and
/// normalised; voxels beyond a face equal those on it.
void blur(Image& image, double sigma, Progress& progress);

/// Thick slices: each the mean over `thickness` voxels along z, of those at its ends the share that
/// it takes in. The first begins where the image does; what is left over at the end is dropped.
Image averageSlices(const Image& image, double thickness);

/// kBackground + kContrast * (occupancy + bias field + noise), rounded. The bias field is a mean of
/// four plane waves of random direction and phase with 0.5 to 1.5 periods along the longest edge,
/// so it lies in [-bias, bias]; `thickness` is that of a slice, in voxels. The noise of a row
/// depends on `seed` and the row only.
std::vector<std::int16_t> degrade(Image& image, double bias, double noise, std::uint64_t seed,
                                  double thickness, Progress& progress);

/// A normal deviate to an excess kurtosis of -0.016, bounded to +-11.5, made from integer
/// arithmetic so that every machine gives the same bits: the centred count of 128 fair bits plus
/// two uniform deviates.
double countedNormal(Random& random);

}  // namespace lumen::convert
