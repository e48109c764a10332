// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/noise_floor.h"

#include <algorithm>
#include <vector>

#include "converters/common/random.h"
#include "converters/volume/icosphere.h"

namespace lumen::convert {
namespace {

constexpr int kPlaces = 64;
constexpr double kRadiusVoxels = 2.0;  // thin vessels are those that noise is mistaken for
constexpr std::uint64_t kStream = ~std::uint64_t{0};

/// The element that the share `rank` of all is below; of a non-empty list, which it reorders.
template <typename T>
double quantile(std::vector<T>& values, double rank) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(rank * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace

double noiseFloor(const BsplineVolume& volume, const TrackOptions& options) {
  const VolumeGeometry& geometry = volume.geometry();
  RayCaster rays(volume, icosphere(icosphereOrder(42)), options.samples, options.dark);
  Random random(options.seed, kStream);
  Candidates points;
  std::vector<double> strengths;
  for (int place = 0; place < kPlaces; ++place) {
    Eigen::Vector3d index;
    for (int a = 0; a < 3; ++a)
      index[a] =
          random.uniform() * static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1);
    rays.cast(geometry.worldFromIndex(index), 3.0 * kRadiusVoxels * geometry.voxelSize(), points);
    strengths.push_back(points.count() == 0 ? 0.0 : quantile(points.strength, 0.5));
  }
  return quantile(strengths, 0.25);
}

}  // namespace lumen::convert
