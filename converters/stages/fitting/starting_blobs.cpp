// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/starting_blobs.h"

#include <algorithm>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert::fitting {
namespace {

/// Stragglers: one point in this many, at either end of the vessel, is beyond the cover of the
/// first blobs.
constexpr std::size_t kStragglers = 20;
/// Least distance of an end from the middle, in radii. Points in one ring have no ends.
constexpr double kLeastHalf = 0.5;
/// Least distance of the balls that the second trial begins with, in radii of the wider one.
constexpr double kBallsApart = 0.8;

/// The width of two equal blobs that have that radius when both are in one place.
double widthOfTwo(const EnergyParameters& e, double radius) {
  return formats::widthForRadius(e.kernel, e.kernelParameter, radius, e.isoLevel, 2);
}

/// The ends of the points along the node's direction; a radius to either side if they are too few.
std::pair<double, double> endsAlong(const NodeData& node) {
  if (node.points.size() < kFewestPoints) return {-node.radius, node.radius};
  const formats::Vec3d& direction = node.direction;
  std::vector<double> along;
  along.reserve(node.points.size());
  for (const formats::Vec3d& p : node.points)
    along.push_back(p.x * direction.x + p.y * direction.y + p.z * direction.z);
  const std::size_t tail = along.size() / kStragglers;
  const double low = valueAtRank(along, tail), high = valueAtRank(along, along.size() - 1 - tail);
  const double middle = 0.5 * (low + high), least = kLeastHalf * node.radius;
  return {std::min(low, middle - least), std::max(high, middle + least)};
}

}  // namespace

std::vector<Blob> placeAlongVessel(const EnergyParameters& parameters, const NodeData& node) {
  if (!node.start.empty()) return {node.start.begin(), node.start.end()};
  const formats::Vec3d& direction = node.direction;
  const auto [low, high] = endsAlong(node);
  const double width = widthOfTwo(parameters, node.radius);
  std::vector<Blob> blobs;
  // quarter and three quarters of the distance from one end to the other
  for (const double along : {0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high})
    blobs.push_back({along * direction.x, along * direction.y, along * direction.z, width});
  return blobs;
}

std::vector<Blob> placeInLumen(const EnergyParameters& parameters, std::span<const FitBall> lumen) {
  std::vector<Blob> blobs;
  std::vector<const FitBall*> kept;
  for (const FitBall& ball : lumen) {
    const auto isNear = [&](const FitBall* other) {
      const double dx = ball.centre.x - other->centre.x, dy = ball.centre.y - other->centre.y;
      const double dz = ball.centre.z - other->centre.z;
      const double apart = kBallsApart * std::max(ball.radius, other->radius);
      return dx * dx + dy * dy + dz * dz < apart * apart;
    };
    if (std::any_of(kept.begin(), kept.end(), isNear)) continue;
    kept.push_back(&ball);
    blobs.push_back(
        {ball.centre.x, ball.centre.y, ball.centre.z, widthOfTwo(parameters, ball.radius)});
  }
  return blobs;
}

}  // namespace lumen::convert::fitting
