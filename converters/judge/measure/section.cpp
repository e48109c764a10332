// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kRays = WallRing::kRays;
constexpr double kStep = 2 * std::numbers::pi / static_cast<double>(kRays);
// A wall steeper against the plane's rays than this is a fold of the ring: its slope is cut.
constexpr double kLeastSlope = 0.1;

/// The farthest reach of the ring in a direction: the parabola through the farthest point and its
/// neighbours.
double support(const std::array<Vector3d, kRays>& out, const Vector3d& direction) {
  std::array<double, kRays> reach;
  for (std::size_t i = 0; i < kRays; ++i) reach[i] = out[i].dot(direction);
  const auto most = std::max_element(reach.begin(), reach.end());
  const auto i = static_cast<std::size_t>(most - reach.begin());
  const double before = reach[(i + kRays - 1) % kRays], after = reach[(i + 1) % kRays];
  const double bend = 2 * *most - before - after, slope = 0.5 * (after - before);
  return bend > 0 ? *most + 0.5 * slope * slope / bend : *most;
}

void findDiameters(const CutPlane& plane, const WallRing& ring, Section& section) {
  std::array<Vector3d, kRays> out;
  for (std::size_t i = 0; i < kRays; ++i) out[i] = ring.point[i] - plane.centre;
  std::array<double, kRays / 2> width;
  for (std::size_t i = 0; i < kRays / 2; ++i) {
    const Vector3d direction = out[i] / ring.distance[i];
    width[i] = support(out, direction) + support(out, -direction);
  }
  // the extremes between two directions, again by parabolas
  const auto refined = [&](std::size_t i, double sign) {
    const std::size_t n = width.size();
    const double a = width[(i + n - 1) % n], b = width[i], c = width[(i + 1) % n];
    const double bend = sign * (2 * b - a - c), slope = 0.5 * (c - a);
    return bend > 0 ? b + sign * 0.5 * slope * slope / bend : b;
  };
  const auto at = [&](auto found) { return static_cast<std::size_t>(found - width.begin()); };
  section.least = refined(at(std::min_element(width.begin(), width.end())), -1);
  section.greatest = refined(at(std::max_element(width.begin(), width.end())), 1);
}

}  // namespace

Section sectionOf(const CutPlane& plane, const WallRing& ring, const Vector3d& bend) {
  Section section;
  Vector3d moment = Vector3d::Zero();
  double wall = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double rho = ring.distance[i];
    const Vector3d out = ring.point[i] - plane.centre, ray = out / rho;
    const Vector3d around = plane.tangent.cross(ray);
    const Vector3d& n = ring.normal[i];
    const double slope = n.dot(around) / std::max(n.dot(ray), kLeastSlope);
    const double arc = rho * std::sqrt(1 + slope * slope) * kStep;
    section.area += 0.5 * rho * rho * kStep;
    moment += rho * rho / 3 * kStep * out;
    section.perimeter += arc;
    const double across = n.dot(plane.tangent);
    wall += arc * (1 - bend.dot(out)) / std::sqrt(std::max(1 - across * across, 0.01));
  }
  section.centroid = plane.centre + moment / section.area;
  section.volumeRate = section.area - bend.dot(moment);
  section.wallRate = wall;
  section.circularity =
      4 * std::numbers::pi * section.area / (section.perimeter * section.perimeter);
  findDiameters(plane, ring, section);
  return section;
}

}  // namespace lumen::convert
