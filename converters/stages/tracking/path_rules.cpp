// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/path_rules.h"

#include <algorithm>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Nodes of about two radii of track, over which a vessel hardly changes.
constexpr std::size_t kRecentNodes = 8;

/// The length that a fit may move the centre along the axis, in steps; more would be another step.
constexpr double kSlackSteps = 0.5;

/// Length in last radii of the chord that gives the course; shorter ones are as noisy as
/// directions.
constexpr double kChordRadii = 1.5;
/// Nodes at the start of a track at which no chord begins: they were fitted without a course.
constexpr std::size_t kUnsettledNodes = 3;

/// A centre within this share of an earlier node's radius is back in its lumen.
constexpr double kBackShare = 0.75;
/// The longest track that a bend makes, in straight distances beyond a radius (half a circle is
/// pi/2 times its diameter).
constexpr double kBendDistances = 1.5;

/// The most nodes that are dropped at a tip, the number of nodes with whose mean radius they are
/// compared, and their least width in such radii: a rounded end is seen for a step or two.
constexpr std::size_t kTipNodes = 3, kNodesBeforeTip = 6;
constexpr double kTipRadii = 1.4;

}  // namespace

bool isAtFace(const VolumeGeometry& geometry, const TrackedNode& node, double sign) {
  return !geometry.containsWorld(node.centre + sign * kEndRadii * node.radius * node.direction);
}

RecentMeans recentMeans(std::span<const TrackedNode> nodes) {
  const std::size_t count = std::min(nodes.size(), kRecentNodes);
  RecentMeans mean;
  for (const TrackedNode& node : nodes.last(count)) {
    mean.inlierRate += node.inlierRate / static_cast<double>(count);
    mean.strength += node.strength / static_cast<double>(count);
    mean.radius += node.radius / static_cast<double>(count);
  }
  return mean;
}

NodeGuess predictNode(const TrackOptions& options, const TrackedNode& from, double steps,
                      const Vector3d& direction) {
  // few wall points make a short height, and a track must advance
  const double step = std::max(options.step * from.height, 0.5 * kSpacingRadii * from.radius);
  return {from.centre + steps * step * direction, direction, from.radius, true, kSlackSteps * step};
}

Vector3d trackDirection(std::span<const TrackedNode> nodes) {
  const TrackedNode& last = nodes.back();
  for (std::size_t i = nodes.size() - 1; i-- > kUnsettledNodes;) {
    const Vector3d chord = last.centre - nodes[i].centre;
    if (chord.norm() >= kChordRadii * last.radius)
      return (last.direction + chord.normalized()).normalized();
  }
  return last.direction;
}

bool isSwollen(const TrackOptions& options, std::span<const TrackedNode> nodes,
               const TrackedNode& next) {
  return next.inlierRate < options.inlierRate && next.radius > kWidest * recentMeans(nodes).radius;
}

std::optional<std::size_t> findTurningPoint(std::span<const TrackedNode> nodes,
                                            const TrackedNode& next) {
  const Vector3d ahead = next.centre - nodes.back().centre;
  if (ahead.dot(nodes.back().direction) <= 0) return nodes.size();
  double length = ahead.norm(), farthest = 0;
  std::size_t turn = nodes.size();
  for (std::size_t i = nodes.size() - 1; i-- > 0;) {
    length += (nodes[i + 1].centre - nodes[i].centre).norm();
    const double distance = (next.centre - nodes[i].centre).norm();
    if (distance > farthest) {
      farthest = distance;
      turn = i;
    }
    if (distance < kBackShare * nodes[i].radius &&
        length > kBendDistances * distance + nodes[i].radius)
      return turn;
  }
  return std::nullopt;
}

void dropTip(std::vector<TrackedNode>& nodes) {
  for (std::size_t dropped = 0; dropped < kTipNodes && nodes.size() > kNodesBeforeTip + 2;
       ++dropped) {
    double radius = 0;
    for (std::size_t i = nodes.size() - 1 - kNodesBeforeTip; i + 1 < nodes.size(); ++i)
      radius += nodes[i].radius / static_cast<double>(kNodesBeforeTip);
    if (nodes.back().radius < kTipRadii * radius) return;
    nodes.pop_back();
  }
}

}  // namespace lumen::convert
