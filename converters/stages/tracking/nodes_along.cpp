// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/nodes_along.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Distance from one node of a bridge to the next, in radii.
constexpr double kSpacingRadii = 0.5;
/// Largest distance of a fitted node from the line, and its least and largest radius, in
/// interpolated radii.
constexpr double kAsideRadii = 0.7, kNarrowRadii = 0.6, kWideRadii = 1.5;

struct Station {
  Vector3d position, direction;
  double radius;
};

/// Evenly spaced places along a polyline, without its ends.
std::vector<Station> stationsAlong(std::span<const Vector3d> line, double first, double last) {
  std::vector<double> at(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) at[i] = at[i - 1] + (line[i] - line[i - 1]).norm();
  const double length = at.back();
  const int count = static_cast<int>(std::floor(length / (kSpacingRadii * std::min(first, last))));
  std::vector<Station> stations;
  const auto place = [&](double t) {
    const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, t);
    const auto i = static_cast<std::size_t>(above - at.begin());
    const double share = at[i] > at[i - 1] ? (t - at[i - 1]) / (at[i] - at[i - 1]) : 0.0;
    return Vector3d(line[i - 1] + share * (line[i] - line[i - 1]));
  };
  for (int n = 1; n < count; ++n) {
    const double t = length * n / count, half = 0.5 * length / count;
    const Vector3d tangent = place(t + half) - place(t - half);
    if (!(tangent.norm() > 0)) continue;
    stations.push_back({place(t), tangent.normalized(), first + (last - first) * n / count});
  }
  return stations;
}

bool inLumen(const TrackedBranch* other, const Vector3d& point) {
  if (!other) return false;
  const ChainPoint at = closestOnChain(other->nodes, point);
  return at.distance < at.radius;
}

TrackedNode bridgedNode(const Station& station) {
  TrackedNode node;
  node.origin = formats::NodeOrigin::Bridged;
  node.centre = station.position;
  node.direction = station.direction;
  node.radius = station.radius;
  node.height = 2 * kSpacingRadii * station.radius;
  return node;
}

}  // namespace

std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Vector3d> line, double first,
                                    double last, const TrackedBranch* parent) {
  std::vector<TrackedNode> nodes;
  for (const Station& station : stationsAlong(line, first, last)) {
    const NodeGuess guess{station.position, station.direction, station.radius, true,
                          0.5 * kSpacingRadii * station.radius};
    std::optional<TrackedNode> node;
    if (!inLumen(parent, station.position))
      node = fitNode(run, guess, leastInlierRate(run.context.options)).node;
    if (node) {
      const Vector3d aside = node->centre - station.position;
      if (aside.norm() > kAsideRadii * station.radius ||
          node->radius < kNarrowRadii * station.radius ||
          node->radius > kWideRadii * station.radius ||
          node->direction.dot(station.direction) < std::numbers::sqrt2 / 2)
        node.reset();
    }
    nodes.push_back(node ? std::move(*node) : bridgedNode(station));
  }
  return nodes;
}

}  // namespace lumen::convert
