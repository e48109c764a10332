// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/click_light.h"

#include <algorithm>
#include <cstdint>

#include "converters/base/random.h"
#include "converters/base/statistics.h"
#include "converters/stages/tracking/smoothing.h"

namespace lumen::convert {
namespace {

/// Places for comparison, and the share of them that may stand out: vessels fill less of a volume.
constexpr std::size_t kLightPlaces = 200;
constexpr double kOutstanding = 0.1;
/// Multiple of the contrast of those places: noise alone reaches it, and stays below twice of it.
constexpr double kClear = 2;
/// Stream of the random numbers; those of the branches count up from 0.
constexpr std::uint64_t kLightStream = ~std::uint64_t{1};

Eigen::Vector3d smoothingOf(const VolumeGeometry& geometry) {
  const double most = BsplineVolume::kMostSmoothing * geometry.spacing.minCoeff();
  return Eigen::Vector3d::Constant(std::min(geometry.voxelSize(), most));
}

}  // namespace

ClickLight::ClickLight(const Volume& volume, const TrackOptions& options, const Progress& progress)
    : m_spline(volume, smoothingOf(volume.geometry)), m_options(options), m_progress(progress) {
  Random random(options.seed, kLightStream);
  const Eigen::Vector3d last = volume.geometry.cells().high().cast<double>();
  std::vector<double> contrasts;
  for (std::size_t i = 0; i < kLightPlaces; ++i) {
    Eigen::Vector3d index;
    for (int a = 0; a < 3; ++a) index[a] = random.uniform() * last[a];
    SeedBranch place;
    place.points.push_back({volume.geometry.worldFromIndex(index), {}});
    contrasts.push_back(contrastAt(place));
  }
  m_usual = lowerQuantile(contrasts, 1 - kOutstanding);
}

double ClickLight::contrastAt(const SeedBranch& seed) const {
  return contrastAtClicks(m_spline, {seed}, m_options, m_progress);
}

std::size_t ClickLight::countInVessels(const std::vector<SeedBranch>& seeds) const {
  return static_cast<std::size_t>(
      std::count_if(seeds.begin(), seeds.end(),
                    [&](const SeedBranch& seed) { return contrastAt(seed) > kClear * m_usual; }));
}

}  // namespace lumen::convert
