// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Extent of the sampled inside, in radii. The band of inliers ends at nine tenths.
constexpr double kInside = 0.8;
/// Sections along the axis, rings of a section, and samples of the first ring, by which number each
/// ring exceeds the last: every sample represents the same area.
constexpr int kSections = 3, kRings = 3, kOnFirstRing = 6;
/// Place of the outer sections, in half heights. Farther out a bend leaves the cylinder.
constexpr double kOuterSection = 0.5;
/// Largest dark share of the inside of one vessel. A circle around the longer axis of an ellipse of
/// axes 3:2, which is a vessel, is dark by a third; a circle that two touching discs of equal size
/// share with the gap between them, by a half.
constexpr double kMostDark = 0.28;
/// The most steps to the middle of a lumen, and the reach of a sample's attraction, in radii.
constexpr int kShifts = 8;
constexpr double kAttraction = 0.4;

struct Sample {
  Vector3d position;
  double value;
};

/// The level halfway down the wall, brighter being more.
double wallLevel(const BsplineVolume& volume, const TrackedNode& node, double sign) {
  std::vector<double> values;
  for (const formats::Vec3f& p : node.points) {
    const double value = sign * volume.sample(volume.geometry().indexFromWorld(toEigen(p)));
    if (!std::isnan(value)) values.push_back(value);
  }
  return values.empty() ? -std::numeric_limits<double>::infinity() : median(std::move(values));
}

/// Samples spread evenly over the inside; those outside of the volume are left out.
std::vector<Sample> sampleInside(const BsplineVolume& volume, const TrackedNode& node,
                                 double sign) {
  std::vector<Sample> samples;
  const auto [u, v] = planeBasis(node.direction);
  const auto add = [&](const Vector3d& position) {
    const double value = sign * volume.sample(volume.geometry().indexFromWorld(position));
    if (!std::isnan(value)) samples.push_back({position, value});
  };
  for (int s = 0; s < kSections; ++s) {
    const double along = kOuterSection * 0.5 * node.height * (2.0 * s / (kSections - 1) - 1.0);
    const Vector3d centre = node.centre + along * node.direction;
    add(centre);
    for (int ring = 1; ring <= kRings; ++ring) {
      const double r = kInside * node.radius * ring / (kRings + 0.5);
      const int count = kOnFirstRing * ring;
      for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        add(centre + r * (std::cos(angle) * u + std::sin(angle) * v));
      }
    }
  }
  return samples;
}

/// The middle of the bright samples around the one nearest to `guess`: where the mean of those near
/// it stays in place (mean shift; K. Fukunaga, L. Hostetler, 1975).
Vector3d findMiddle(const std::vector<Sample>& bright, const Vector3d& guess, double reach) {
  const auto nearer = [&](const Sample& a, const Sample& b) {
    return (a.position - guess).squaredNorm() < (b.position - guess).squaredNorm();
  };
  Vector3d at = std::min_element(bright.begin(), bright.end(), nearer)->position;
  for (int step = 0; step < kShifts; ++step) {
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    for (const Sample& sample : bright) {
      const double weight = std::exp(-(sample.position - at).squaredNorm() / (reach * reach));
      sum += weight * sample.position;
      weights += weight;
    }
    at = sum / weights;
  }
  return at;
}

}  // namespace

WallSupport wallSupport(const BsplineVolume& volume, const TrackedNode& node, const Vector3d& guess,
                        bool dark) {
  const double sign = dark ? -1.0 : 1.0;
  WallSupport support{0, node.centre, node.radius};
  if (node.points.empty()) return support;
  const double level = wallLevel(volume, node, sign);
  std::vector<Sample> samples = sampleInside(volume, node, sign);
  const std::size_t all = samples.size();
  std::erase_if(samples, [&](const Sample& s) { return s.value < level; });
  if (all == 0) return support;
  const double bright = static_cast<double>(samples.size()) / static_cast<double>(all);
  support.dark = 1.0 - bright;
  support.radius = node.radius * std::sqrt(bright);
  if (!samples.empty()) support.middle = findMiddle(samples, guess, kAttraction * node.radius);
  return support;
}

bool isSupported(const WallSupport& support) {
  return support.dark <= kMostDark;
}

}  // namespace lumen::convert
