// SPDX-License-Identifier: Apache-2.0
// Rendering of a design into voxels.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/stages/phantom/design.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Intensity far from vessels, before bias and noise.
constexpr double kBackground = 100;
/// Intensity that a vessel which fills a voxel adds to the background.
constexpr double kContrast = 1000;

/// Values of voxels, x fastest.
struct Image {
  Cell size = Cell::Zero();
  std::vector<float> value;
  [[nodiscard]] std::size_t index(int y, int z) const {  ///< where a row begins
    return CellBox{Cell::Zero(), size}.index({0, y, z});
  }
  float* row(int y, int z) { return value.data() + index(y, z); }
};

/// The share of each voxel that lies in the lumen, times the local contrast of the design, in [0,
/// 1]. Voxels that the wall may cross are integrated over subvoxels, three along their least edge
/// and about cubic, each weighted by its own signed distance. The grid has the axes of LPS.
Image drawOccupancy(const Design& design, const VolumeGeometry& grid, Progress& progress);

/// The taps of a Gaussian of standard deviation `sigma` voxels, cut at 4 sigma and normalised; one
/// tap for 0.
std::vector<float> gaussianWeights(double sigma);

/// Convolves in place with a Gaussian of standard deviation `sigma` voxels along each axis, by
/// gaussianWeights(); voxels beyond a face equal those on it.
void blur(Image& image, const Eigen::Vector3d& sigma, Progress& progress);

/// Averages an image over thick slices of `thickness` voxels along z; voxels at the ends of a slice
/// count by the share that it takes in. The first slice begins where the image does; the rest at
/// the end is dropped.
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
