// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/surface_projection.h"

#include <algorithm>
#include <cmath>

namespace lumen {
namespace {

constexpr int kMaxSteps = 40;         // three to five near the wall; the rest is for long paths
constexpr double kTolerance = 1e-4;   // relative to the radius
constexpr double kLongestStep = 0.3;  // relative to the radius: far from the wall h is not straight
constexpr double kVanished = 1e-12;   // relative to the level: below, f is not significant
constexpr double kFlat = 1e-10;       // limit of |grad f|, which has no unit

}  // namespace

std::optional<SurfacePoint> projectOnSurface(const field::BlendedField& surface,
                                             const Eigen::Vector3d& start, std::uint32_t node,
                                             double radius, const Eigen::Vector3d* plane) {
  const double level = surface.level();
  const double wanted = field::levelTransform(surface.kernel(), level).h;
  SurfacePoint at{start, Eigen::Vector3d::Zero(), node};
  for (int step = 0; step < kMaxSteps; ++step) {
    const field::Vec point{at.position.x(), at.position.y(), at.position.z()};
    at.node = surface.follow(point, at.node);
    const field::Jet<1> f = surface.blended(point, at.node);
    at.gradient = Eigen::Vector3d(f.gradient);
    Eigen::Vector3d along = at.gradient;
    if (plane != nullptr) along -= along.dot(*plane) * *plane;
    const double slope = along.norm();
    if (!(f.value > kVanished * level) || !(slope > kFlat)) return std::nullopt;
    const field::LevelTransform here = field::levelTransform(surface.kernel(), f.value, slope);
    const double distance = (here.h - wanted) / here.slope;  // along the gradient, inwards
    if (std::abs(distance) <= kTolerance * radius) return at;
    const double longest = kLongestStep * radius;
    at.position += std::clamp(distance, -longest, longest) / slope * along;
  }
  return std::nullopt;
}

}  // namespace lumen
