// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Places of a disc of radius 1: its middle, and rings with equal areas for each place.
constexpr double kRing = 1.7;
constexpr int kInner = 4, kOuter = 8, kAround = 10;

Vector3d smoothingOf(const Volume& volume, double smoothing) {
  const Vector3d& spacing = volume.geometry.spacing;
  return spacing.cwiseMin(smoothing / BsplineVolume::kMostSmoothing * Vector3d::Ones())
      .cwiseProduct(Vector3d::Constant(BsplineVolume::kMostSmoothing))
      .cwiseMin(Vector3d::Constant(smoothing));
}

}  // namespace

Evidence::Evidence(const Volume& volume, bool dark, double smoothing)
    : m_voxels(volume, smoothingOf(volume, smoothing)), m_sign(dark ? -1.0 : 1.0) {}

Evidence::Disc Evidence::discAt(const Vector3d& centre, const Vector3d& direction,
                                double radius) const {
  const auto [u, v] = planeBasis(direction);
  const VolumeGeometry& geometry = m_voxels.geometry();
  const auto meanOf = [&, &u = u, &v = v](double at, int count) {
    double sum = 0;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / count;
      const Vector3d place = centre + at * radius * (std::cos(angle) * u + std::sin(angle) * v);
      sum += double{m_voxels.sample(geometry.indexFromWorld(place))};
    }
    return sum / count;
  };
  const double middle = double{m_voxels.sample(geometry.indexFromWorld(centre))};
  const double inside = (middle + kInner * meanOf(0.45, kInner) + kOuter * meanOf(0.8, kOuter)) /
                        (1 + kInner + kOuter);
  return {m_sign * inside, m_sign * meanOf(kRing, kAround)};
}

double Evidence::contrastAt(const Vector3d& centre, const Vector3d& direction,
                            double radius) const {
  const Disc disc = discAt(centre, direction, radius);
  const double contrast = disc.inside - disc.around;
  return std::isfinite(contrast) ? contrast : 0.0;
}

double Evidence::contrastOfEnd(const Vector3d& centre, const Vector3d& direction,
                               const Vector3d& outward, double radius) const {
  const Disc disc = discAt(centre, direction, radius);
  const Disc beyond = discAt(centre + 2 * radius * outward, direction, radius);
  const double contrast = disc.inside - std::max(disc.around, beyond.inside);
  return std::isfinite(contrast) ? contrast : 0.0;
}

}  // namespace lumen::convert
