// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/random.h"
#include "converters/base/statistics.h"
#include "converters/geometry/icosphere.h"

namespace lumen::convert {
namespace {

/// Rays from each place or click: enough for a median, and far fewer than tracking casts.
constexpr int kRays = 42;

/// Places that the noise floor is taken from, and the fewest where voxels are so uneven that rays
/// cross many of them: the spline must be made wherever they go.
constexpr int kNoisePlaces = 64, kFewestPlaces = 8;
/// Voxels along the finest axis: rays up to this length are cast from all places.
constexpr double kLongRay = 32.0;
/// Voxels: the radius that noise is measured at. Noise resembles thin vessels.
constexpr double kRadiusVoxels = 2.0;
/// Quantile of the places: vessels and organs lie in the upper three quarters.
constexpr double kEmptyShare = 0.25;
/// Seed and stream of the random places. The noise is the volume's, whatever the seed of the tracks:
/// it decides how far the volume is smoothed. Streams of the branches count up from 0.
constexpr std::uint64_t kNoiseSeed = 1;
constexpr std::uint64_t kNoiseStream = ~std::uint64_t{0};

/// Voxels: length of the rays that sample the surroundings of a click.
constexpr int kRayVoxels = 16;
/// The most clicks whose contrast is measured, to bound the time.
constexpr std::size_t kMostClicks = 256;
/// Quantile of a ray's samples that is the vessel's surroundings, even if the ray runs along it for
/// a while.
constexpr double kAroundShare = 0.25;

/// Voxels: the smoothing that is tried, least first.
constexpr std::array kSmoothing = {0.5, 0.6, 0.7, 0.85, 1.0, 1.25};
/// The ratio of a wall's strength to that of noise at which nothing more is smoothed. Tracks leave
/// their vessels below it.
constexpr double kStrongEnough = 6.0;
/// Voxels: standard deviation of a scanner's blur and the voxel's own box.
constexpr double kUsualSpread = 2.0 / 3.0;

/// Voxel edges: the blur that sampling leaves (D. Lowe, "Distinctive image features from
/// scale-invariant keypoints", 2004, section 3.3).
constexpr double kSampling = 0.5;
/// Ratio of edges up to which a difference in blur costs less than more blur does.
constexpr double kBearable = 1.5;

/// The number of places that the noise floor of a volume is taken from.
std::size_t countPlaces(const VolumeGeometry& geometry) {
  const double voxels =
      kRayRadii * kRadiusVoxels * geometry.voxelSize() / geometry.spacing.minCoeff();
  const double share = std::min(1.0, kLongRay / voxels);
  return static_cast<std::size_t>(std::max<double>(kFewestPlaces, kNoisePlaces * share * share));
}

/// The median strength of the walls that rays find around a place.
double strengthAround(const BsplineVolume& volume, const TrackOptions& options,
                      const Eigen::Vector3d& index) {
  const VolumeGeometry& geometry = volume.geometry();
  RayCaster rays(volume, icosphere(icosphereOrder(kRays)), options.samples, options.dark);
  Candidates points;
  rays.cast(geometry.worldFromIndex(index), kRayRadii * kRadiusVoxels * geometry.voxelSize(),
            points);
  return points.count() == 0 ? 0.0 : double{lowerQuantile(points.strength, 0.5)};
}

/// The difference between a click and the lower quartile of the samples of rays around it.
float contrastAt(const BsplineVolume& volume, const Eigen::Vector3d& click, float sign) {
  const VolumeGeometry& geometry = volume.geometry();
  std::vector<float> values(kRayVoxels + 1), inside, around;
  for (const Eigen::Vector3d& ray : icosphere(icosphereOrder(kRays))) {
    const Eigen::Vector3d step = (geometry.direction.transpose() * ray * geometry.voxelSize())
                                     .cwiseQuotient(geometry.spacing);
    volume.sampleLine(click, step, values);
    inside.clear();
    for (const float value : values)
      if (!std::isnan(value)) inside.push_back(sign * value);
    around.push_back(lowerQuantile(inside, kAroundShare));
  }
  return sign * volume.sample(click) - lowerQuantile(around, 0.5);
}

}  // namespace

double noiseFloor(const BsplineVolume& volume, const TrackOptions& options,
                  const Progress& progress) {
  const VolumeGeometry& geometry = volume.geometry();
  Random random(kNoiseSeed, kNoiseStream);
  std::vector<Eigen::Vector3d> places(countPlaces(geometry));
  for (Eigen::Vector3d& index : places)
    for (int a = 0; a < 3; ++a)
      index[a] =
          random.uniform() * static_cast<double>(geometry.size[static_cast<std::size_t>(a)] - 1);
  std::vector<double> strengths(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    progress.check();
    strengths[i] = strengthAround(volume, options, places[i]);
  });
  return lowerQuantile(strengths, kEmptyShare);
}

double contrastAtClicks(const BsplineVolume& volume, const std::vector<SeedBranch>& seeds,
                        const TrackOptions& options, const Progress& progress) {
  const VolumeGeometry& geometry = volume.geometry();
  const std::size_t count = std::min(seeds.size(), kMostClicks);
  std::vector<float> contrasts(count, std::numeric_limits<float>::quiet_NaN());
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    progress.check();
    const SeedBranch& seed = seeds[i * seeds.size() / count];
    const Eigen::Vector3d click = geometry.indexFromWorld(seed.points[0].position);
    if (geometry.containsIndex(click))
      contrasts[i] = contrastAt(volume, click, options.dark ? -1.0F : 1.0F);
  });
  std::erase_if(contrasts, [](float contrast) { return std::isnan(contrast); });  // outside
  return contrasts.empty() ? 0.0 : std::max(0.0, double{lowerQuantile(contrasts, 0.5)});
}

Eigen::Vector3d smoothingAlongAxes(const VolumeGeometry& geometry, double smoothing,
                                   bool evenBlur) {
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

SmoothedVolume smoothForNoise(const Volume& volume, const VolumeGeometry& geometry,
                              const std::vector<SeedBranch>& seeds, const TrackOptions& options,
                              const Progress& progress) {
  const double voxel = geometry.voxelSize();
  const double most = BsplineVolume::kMostSmoothing * geometry.spacing.minCoeff();
  const auto smoothed = [&](double smoothing) {
    auto spline = std::make_unique<BsplineVolume>(
        volume, geometry, smoothingAlongAxes(geometry, smoothing, options.evenBlur));
    const double floor = noiseFloor(*spline, options, progress);
    return SmoothedVolume{std::move(spline), smoothing, floor};
  };
  SmoothedVolume out = smoothed(std::min(options.smoothing.value_or(0.0), most));
  if (options.smoothing || out.noiseFloor == 0) return out;
  const double contrast = contrastAtClicks(
      BsplineVolume(volume, geometry, Eigen::Vector3d::Constant(std::min(voxel, most))), seeds,
      options, progress);
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
