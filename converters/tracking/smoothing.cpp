// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "converters/common/random.h"
#include "converters/tracking/icosphere.h"

namespace lumen::convert {
namespace {

constexpr int kPlaces = 64;
constexpr double kRadiusVoxels = 2.0;  // thin vessels are those that noise is mistaken for
constexpr std::uint64_t kStream = ~std::uint64_t{0};

constexpr int kReach = 16;                                           // voxels
constexpr std::array kSmoothing = {0.5, 0.6, 0.7, 0.85, 1.0, 1.25};  // voxels
constexpr double kStrongEnough = 6.0;
constexpr double kUsualSpread = 2.0 / 3.0;  // voxels: a scanner's blur and the voxel's own box

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

double contrastAtClicks(const BsplineVolume& volume, const std::vector<SeedBranch>& seeds,
                        const TrackOptions& options) {
  const VolumeGeometry& geometry = volume.geometry();
  const float sign = options.dark ? -1.0F : 1.0F;
  std::vector<float> contrasts, values(kReach + 1), inside, around;
  for (const SeedBranch& seed : seeds) {
    const Eigen::Vector3d click = geometry.indexFromWorld(seed.points[0].position);
    if (!geometry.containsIndex(click)) continue;
    around.clear();
    for (const Eigen::Vector3d& ray : icosphere(icosphereOrder(42))) {
      const Eigen::Vector3d step = (geometry.direction.transpose() * ray * geometry.voxelSize())
                                       .cwiseQuotient(geometry.spacing);
      volume.sampleLine(click, step, values);
      inside.clear();
      for (const float value : values)
        if (!std::isnan(value)) inside.push_back(sign * value);
      around.push_back(static_cast<float>(quantile(inside, 0.25)));
    }
    contrasts.push_back(sign * volume.sample(click) - static_cast<float>(quantile(around, 0.5)));
  }
  return contrasts.empty() ? 0.0 : std::max(0.0, quantile(contrasts, 0.5));
}

Eigen::Vector3d smoothingAlongAxes(const VolumeGeometry& geometry, double smoothing,
                                   bool evenBlur) {
  // the blur that sampling leaves, in edges (D. Lowe, "Distinctive image features from
  // scale-invariant keypoints", 2004, section 3.3)
  constexpr double kSampling = 0.5;
  constexpr double kBearable = 1.5;  // edges: less of a difference costs less than more blur does
  const double coarsest = geometry.spacing.maxCoeff();
  Eigen::Vector3d out;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double edge = geometry.spacing[a], borne = kBearable * edge;
    const double missing = evenBlur ? std::max(0.0, coarsest * coarsest - borne * borne) : 0.0;
    out[a] = std::min(std::sqrt(smoothing * smoothing + kSampling * kSampling * missing),
                      BsplineVolume::kMostSmoothing * edge);
  }
  return out;
}

SmoothedVolume smoothForNoise(const Volume& volume, const std::vector<SeedBranch>& seeds,
                              const TrackOptions& options) {
  const double voxel = volume.geometry.voxelSize();
  const double most = BsplineVolume::kMostSmoothing * volume.geometry.spacing.minCoeff();
  const auto smoothed = [&](double smoothing) {
    auto spline = std::make_unique<BsplineVolume>(
        volume, smoothingAlongAxes(volume.geometry, smoothing, options.evenBlur));
    const double floor = noiseFloor(*spline, options);
    return SmoothedVolume{std::move(spline), smoothing, floor};
  };
  SmoothedVolume out = smoothed(std::min(options.smoothing.value_or(0.0), most));
  if (options.smoothing || out.noiseFloor == 0) return out;
  const double contrast = contrastAtClicks(
      BsplineVolume(volume, Eigen::Vector3d::Constant(std::min(voxel, most))), seeds, options);
  if (contrast == 0) return out;
  const auto enough = [&](const SmoothedVolume& candidate) {
    // the steepest slope of a straight edge
    const double usual = kUsualSpread * voxel;
    const double spread = std::sqrt(candidate.smoothing * candidate.smoothing + usual * usual);
    const double wall = contrast / (std::sqrt(2.0 * std::numbers::pi) * spread);
    return wall >= kStrongEnough * candidate.noiseFloor;
  };
  if (enough(out)) return out;
  for (const double scale : kSmoothing)
    if (SmoothedVolume next = smoothed(std::min(scale * voxel, most)); enough(next)) return next;
  return out;
}

}  // namespace lumen::convert
